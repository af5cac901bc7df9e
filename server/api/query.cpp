#include "server/api/query.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "server/api/problem.hpp"

namespace repose::server {

std::optional<std::string> Query::once(std::string_view name) {
  const std::string key(name);
  const auto count = request_.query.count(key);
  if (count == 0) return std::nullopt;
  if (count > 1) complain(name, key + " is there more than once", "", "once");
  return request_.query.find(key)->second;
}

void Query::complain(std::string_view name,
                     const std::string& message,
                     const std::string& found,
                     const std::string& allowed) {
  problems_.push_back({"?" + std::string(name), message, found, allowed});
}

std::optional<std::int64_t> Query::whole_in(const std::string& text,
                                            std::string_view name,
                                            std::int64_t least,
                                            std::int64_t most) {
  std::int64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec == std::errc{} && result.ptr == end && value >= least && value <= most)
    return value;
  constexpr std::size_t longest = 40;
  complain(name,
           std::string(name) + " is a whole number in its bounds",
           "\"" + text.substr(0, longest) + "\"",
           std::to_string(least) + " to " + std::to_string(most));
  return std::nullopt;
}

std::optional<std::int64_t> Query::whole(std::string_view name,
                                         std::int64_t least,
                                         std::int64_t most) {
  const auto text = once(name);
  if (!text) return std::nullopt;
  return whole_in(*text, name, least, most);
}

std::optional<std::int64_t> Query::whole_field(const std::string& name, std::int64_t least) {
  const std::string text = request_.field(name);
  if (text.empty()) return std::nullopt;
  return whole_in(text, name, least, std::numeric_limits<std::int64_t>::max());
}

std::optional<std::string> Query::text(std::string_view name) { return once(name); }

bool Query::truth(std::string_view name) {
  const auto text = once(name);
  if (!text || *text == "false") return false;
  if (*text == "true") return true;
  constexpr std::size_t longest = 40;
  complain(name,
           std::string(name) + " is true or false",
           "\"" + text->substr(0, longest) + "\"",
           "true, false");
  return false;
}

Reply Query::refusal() const { return problem_reply(400, "The query has problems.", problems_); }

Problems unknown_fields(const Request& request, const Route& route) {
  std::string allowed;
  for (const QueryField& field : route.query) {
    allowed += (allowed.empty() ? "" : ", ") + std::string(field.name);
  }
  Problems problems;
  constexpr std::size_t longest = 40;
  for (const auto& [name, value] : request.query) {
    if (std::ranges::find(route.query, std::string_view(name), &QueryField::name) !=
        route.query.end()) {
      continue;
    }
    problems.push_back({"?" + name.substr(0, longest),
                        "there is no such field of the query here",
                        "\"" + name.substr(0, longest) + "\"",
                        allowed.empty() ? "no field at all" : allowed});
  }
  return problems;
}

}  // namespace repose::server
