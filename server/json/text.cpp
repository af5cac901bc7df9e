#include "server/json/text.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <set>
#include <utility>
#include <vector>

namespace repose::server {

namespace {

/// Builds the value while the text is read, and stops at the first limit.
class LimitedReader final : public nlohmann::json_sax<Json> {
 public:
  LimitedReader(const TextLimits& limits, ProblemList& problems)
      : limits_(limits), problems_(problems) {}

  Json take() { return std::move(root_); }

  bool null() override { return add(Json(nullptr)); }
  bool boolean(bool value) override { return add(Json(value)); }
  bool number_integer(number_integer_t value) override { return add(Json(value)); }
  bool number_unsigned(number_unsigned_t value) override { return add(Json(value)); }
  bool number_float(number_float_t value, const string_t&) override { return add(Json(value)); }
  bool string(string_t& value) override { return short_enough(value) && add(Json(value)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    if (!short_enough(name)) return false;
    Level& level = levels_.back();
    level.key = name;
    if (!level.keys.insert(name).second) {
      problems_.add({pointer_to(level.pointer, name),
                     "the member \"" + clipped(name) + "\" is there twice",
                     "a second one",
                     "each member once"});
    }
    return true;
  }

  bool parse_error(std::size_t, const std::string&, const Json::exception& error) override {
    std::string message = error.what();
    if (const auto end = message.find("] "); end != std::string::npos) message.erase(0, end + 2);
    problems_.add({"", "this is no JSON: " + clipped(message), "", "a JSON document (RFC 8259)"});
    return false;
  }

 private:
  struct Level {
    Json* container;
    std::string pointer;
    std::string key;
    std::set<std::string> keys;
  };

  static std::string clipped(const std::string& text) {
    constexpr std::size_t longest = 200;
    if (text.size() <= longest) return text;
    std::size_t end = longest;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
    return text.substr(0, end) + "...";
  }

  [[nodiscard]] std::string here() const {
    if (levels_.empty()) return "";
    const Level& level = levels_.back();
    return level.container->is_object() ? pointer_to(level.pointer, clipped(level.key))
                                        : pointer_to(level.pointer, level.container->size());
  }

  bool refuse(const std::string& message, const std::string& allowed) {
    problems_.add({here(), message, "", allowed});
    return false;
  }

  bool short_enough(const std::string& text) {
    if (text.size() <= limits_.string_bytes) return true;
    return refuse("a text of " + std::to_string(text.size()) + " bytes is too long",
                  "at most " + std::to_string(limits_.string_bytes) + " bytes");
  }

  /// Puts a value where it belongs. A container stays where it is put until it is closed: only the
  /// innermost one grows.
  Json* place(Json&& value) {
    if (levels_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Level& level = levels_.back();
    if (level.container->is_array()) {
      level.container->push_back(std::move(value));
      return &level.container->back();
    }
    auto& members = level.container->get_ref<Json::object_t&>();
    // Appended without a look for an equal key: `keys` has done that.
    members.Container::push_back({level.key, std::move(value)});
    return &members.back().second;
  }

  bool counted() {
    if (++values_ <= limits_.values) return true;
    return refuse("the document has too many values",
                  "at most " + std::to_string(limits_.values) + " values");
  }

  bool add(Json&& value) {
    if (!counted()) return false;
    place(std::move(value));
    return true;
  }

  bool open(Json&& value) {
    if (!counted()) return false;
    if (levels_.size() >= limits_.depth) {
      return refuse("the document is nested too deeply",
                    "at most " + std::to_string(limits_.depth) + " levels");
    }
    std::string pointer = here();
    Json* const container = place(std::move(value));
    levels_.push_back({container, std::move(pointer), {}, {}});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return true;
  }

  const TextLimits& limits_;
  ProblemList& problems_;
  Json root_;
  std::vector<Level> levels_;
  std::size_t values_ = 0;
};

}  // namespace

std::optional<Json> parse_text(std::string_view text,
                               const TextLimits& limits,
                               ProblemList& problems) {
  if (text.size() > limits.bytes) {
    problems.add({"",
                  "the document is too large",
                  std::to_string(text.size()) + " bytes",
                  "at most " + std::to_string(limits.bytes) + " bytes"});
    return std::nullopt;
  }
  LimitedReader reader(limits, problems);
  if (!Json::sax_parse(text.begin(), text.end(), &reader)) return std::nullopt;
  return reader.take();
}

std::string to_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Page print_page(Json items, int limit, const Json& last) {
  const bool more = !items.empty() && items.size() >= static_cast<std::size_t>(limit);
  Json page;
  page["items"] = std::move(items);
  page["next"] = more ? last : Json(nullptr);
  if (!more) return {to_text(page), {}};
  return {to_text(page), last.is_string() ? last.get<std::string>() : to_text(last)};
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

double number_or_nan(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

std::string text_or_empty(const Json& json) {
  return json.is_null() ? std::string() : json.get<std::string>();
}

std::string print_time(std::int64_t microseconds) {
  const std::time_t seconds = microseconds / 1'000'000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 40> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &utc);
  std::array<char, 16> fraction{};
  std::snprintf(
      fraction.data(), fraction.size(), ".%06dZ", static_cast<int>(microseconds % 1'000'000));
  return std::string(text.data(), length) + fraction.data();
}

Json time_or_null(const std::optional<std::int64_t>& microseconds) {
  return microseconds ? Json(print_time(*microseconds)) : Json(nullptr);
}

Json document_or_null(const std::optional<std::string>& text) {
  return text ? Json::parse(*text, nullptr, false) : Json(nullptr);
}

std::string pointer_to(std::string_view parent, std::string_view member) {
  std::string result(parent);
  result += '/';
  for (const char letter : member) {
    if (letter == '~') {
      result += "~0";
    } else if (letter == '/') {
      result += "~1";
    } else {
      result += letter;
    }
  }
  return result;
}

std::string pointer_to(std::string_view parent, std::size_t index) {
  return pointer_to(parent, std::to_string(index));
}

std::optional<std::int64_t> whole_member(std::string_view document, std::string_view member) {
  ProblemList ignored;
  const auto json = parse_text(document, own_text(document), ignored);
  if (!json || !json->is_object()) return std::nullopt;
  const auto found = json->find(member);
  if (found == json->end() || !found->is_number_integer()) return std::nullopt;
  return found->get<std::int64_t>();
}

}  // namespace repose::server
