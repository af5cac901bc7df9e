#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

#include "db/store.hpp"
#include "server/access/tokens.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/exit_code.hpp"
#include "server/cli/input.hpp"
#include "server/cli/text_table.hpp"
#include "server/jobs/clock.hpp"
#include "server/json/text.hpp"
#include "server/json/token_json.hpp"
#include "server/letters.hpp"

namespace repose::server {

namespace {

std::string day(const std::optional<std::int64_t>& time) {
  constexpr std::size_t letters = 10;  // 2026-11-23
  return time ? print_time(*time).substr(0, letters) : "-";
}

bool is_there(const std::filesystem::path& path) { return std::filesystem::exists(path); }

/// Tokens are looked for only where some have been made, or a database stands.
std::optional<InputError> no_tokens(const std::filesystem::path& database) {
  if (is_there(database) || is_there(Tokens::file_for(database))) return std::nullopt;
  return InputError{"there is no database " + database.string() +
                        ", and there are no tokens for it; --db FILE or REPOSE_DB names another",
                    {}};
}

/// A name is a word in a line of a table.
std::optional<InputError> objection_to_name(const std::string& name) {
  constexpr std::size_t longest = 100;  // bytes
  if (!trimmed(name).empty() && name.size() <= longest && is_utf8(name) &&
      !has_control_letter(name)) {
    return std::nullopt;
  }
  return InputError{
      "a token's name is one line of 1 to 100 bytes, in UTF-8: whose token it is, for instance ada",
      {}};
}

}  // namespace

int create_token_command(const TokenCommand& command) {
  if (const auto why = objection_to_name(command.name)) return report_error(*why, false);
  // A service that others can reach starts only where there is a token: its first one may be made
  // before its database. So a file that is not there is a word of warning, not an error.
  if (is_there(command.database)) {
    db::check_file(command.database);
  } else {
    std::cerr << "repose: there is no database " << command.database.string()
              << " yet: the token is for the service that will make it\n";
  }
  constexpr std::int64_t microseconds_a_day = 24LL * 3600 * 1'000'000;
  const auto scope = std::ranges::find(scope_names, command.scope) - scope_names.begin();
  const std::int64_t now = microseconds_now();
  std::optional<std::int64_t> expires_at;
  if (command.days > 0) expires_at = now + command.days * microseconds_a_day;
  Tokens tokens(Tokens::file_for(command.database));
  std::cout << tokens.create(command.name, static_cast<Scope>(scope), expires_at, now) << "\n";
  std::cerr << "repose: keep it: it is not to be had again. Send it as\n"
               "  Authorization: Bearer rps_...\n";
  return exit_code::done;
}

int list_tokens_command(const TokenCommand& command) {
  if (const auto why = no_tokens(command.database)) {
    return report_error(*why, command.form == Form::json);
  }
  const auto tokens = Tokens(Tokens::file_for(command.database)).all();
  const std::int64_t now = microseconds_now();
  if (command.form == Form::json) {
    std::cout << print_token_list(tokens, now) << "\n";
    return exit_code::done;
  }
  TextTable table({"id", "name", "scope", "created", "expires", "revoked", "valid"});
  for (const Token& token : tokens) {
    table.row({token.id,
               token.name,
               std::string(scope_names.at(static_cast<std::size_t>(token.scope))),
               day(token.created_at),
               day(token.expires_at),
               day(token.revoked_at),
               scope_at(token, now) == Scope::nothing ? "no" : "yes"});
  }
  std::cout << table.str();
  return exit_code::done;
}

int revoke_token_command(const TokenCommand& command) {
  if (const auto why = no_tokens(command.database)) return report_error(*why, false);
  if (Tokens(Tokens::file_for(command.database)).revoke(command.id, microseconds_now())) {
    return exit_code::done;
  }
  std::cerr << "repose: there is no token " << command.id
            << " that is not revoked; `repose token list` shows them\n";
  return exit_code::failed;
}

}  // namespace repose::server
