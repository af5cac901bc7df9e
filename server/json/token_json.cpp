#include "server/json/token_json.hpp"

#include <utility>

#include "server/json/place.hpp"
#include "server/json/text.hpp"

namespace repose::server {

namespace {

Json whole_or_null(const std::optional<std::int64_t>& value) {
  return value ? Json(*value) : Json(nullptr);
}

constexpr std::size_t longest = 1000;  // bytes of a text in the file
constexpr std::int64_t latest = INT64_MAX;

std::optional<std::int64_t> time_at(const Place& place) {
  if (!place.exists() || place.json().is_null()) return std::nullopt;
  return place.whole(0, latest);
}

Token read_token(const Place& place) {
  Members members(place);
  Token token;
  token.id = members.required("id", "an id").text(longest).value_or("");
  token.name = members.required("name", "a name").text(longest).value_or("");
  token.secret_digest = members.required("sha256", "a digest").text(longest).value_or("");
  const auto scope = members.required("scope", "a scope").one_of(scope_names, "scope");
  token.scope = static_cast<Scope>(scope.value_or(0));
  token.created_at = members.required("created_at", "a time").whole(0, latest).value_or(0);
  token.expires_at = time_at(members.optional("expires_at"));
  token.revoked_at = time_at(members.optional("revoked_at"));
  members.no_others();
  return token;
}

}  // namespace

std::string print_tokens(const std::vector<Token>& tokens) {
  Json items = Json::array();
  for (const Token& token : tokens) {
    items.push_back({{"id", token.id},
                     {"name", token.name},
                     {"sha256", token.secret_digest},
                     {"scope", scope_names.at(static_cast<std::size_t>(token.scope))},
                     {"created_at", token.created_at},
                     {"expires_at", whole_or_null(token.expires_at)},
                     {"revoked_at", whole_or_null(token.revoked_at)}});
  }
  return to_text(Json{{"tokens", std::move(items)}}, 2) + "\n";
}

std::optional<std::vector<Token>> read_tokens(std::string_view text) {
  ProblemList problems;
  const auto json = parse_text(text, own_text(text), problems);
  if (!json) return std::nullopt;
  Members members(Place(&*json, "", problems));
  std::vector<Token> tokens;
  for (const Place& place : members.required("tokens", "a list").elements()) {
    tokens.push_back(read_token(place));
  }
  members.no_others();
  if (!problems.empty()) return std::nullopt;
  return tokens;
}

std::string print_token_list(const std::vector<Token>& tokens, std::int64_t now) {
  Json items = Json::array();
  for (const Token& token : tokens) {
    items.push_back({{"id", token.id},
                     {"name", token.name},
                     {"scope", scope_names.at(static_cast<std::size_t>(token.scope))},
                     {"created_at", print_time(token.created_at)},
                     {"expires_at", time_or_null(token.expires_at)},
                     {"revoked_at", time_or_null(token.revoked_at)},
                     {"valid", scope_at(token, now) != Scope::nothing}});
  }
  return to_text(Json{{"items", std::move(items)}});
}

}  // namespace repose::server
