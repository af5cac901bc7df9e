#include "server/access/tokens.hpp"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "server/access/secret.hpp"
#include "server/json/token_json.hpp"
#include "server/letters.hpp"

namespace repose::server {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view prefix = "rps_";
constexpr std::size_t id_bytes = 6, secret_bytes = 32;

/// Two commands at once do not lose each other's change.
class Turn {
 public:
  explicit Turn(const fs::path& file)
      : descriptor_(open((file.string() + ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
    if (descriptor_ < 0 || flock(descriptor_, LOCK_EX) != 0) {
      throw std::system_error(errno, std::generic_category(), "cannot lock " + file.string());
    }
  }
  ~Turn() { close(descriptor_); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  int descriptor_;
};

void write_whole(const fs::path& file, std::string_view text) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const auto fail = [&] {
    const std::system_error error(errno, std::generic_category(), "cannot write " + file.string());
    if (descriptor >= 0) close(descriptor);
    throw error;
  };
  if (descriptor < 0) fail();
  while (!text.empty()) {
    const ssize_t count = ::write(descriptor, text.data(), text.size());
    if (count < 0) fail();
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  if (fsync(descriptor) != 0) fail();
  close(descriptor);
}

}  // namespace

Scope scope_at(const Token& token, std::int64_t now) {
  if (token.revoked_at || (token.expires_at && *token.expires_at <= now)) return Scope::nothing;
  return token.scope;
}

fs::path Tokens::file_for(const fs::path& database) { return database.string() + ".tokens"; }

std::vector<Token> Tokens::all() {
  const std::scoped_lock hold(mutex_);
  std::error_code missing;
  const auto size = fs::file_size(file_, missing);
  if (missing == std::errc::no_such_file_or_directory) {
    if (tokens_.empty()) return {};
    throw std::runtime_error(file_.string() +
                             " is gone: put it back, or make a token with `repose token create`");
  }
  const auto changed = fs::last_write_time(file_);
  if (size == read_size_ && changed == read_at_) return tokens_;
  std::ifstream stream(file_);
  std::ostringstream text;
  text << stream.rdbuf();
  auto tokens = read_tokens(text.str());
  if (!stream || !tokens) throw std::runtime_error(file_.string() + " holds no tokens");
  tokens_ = *std::move(tokens);
  read_size_ = size;
  read_at_ = changed;
  return tokens_;
}

void Tokens::write(const std::vector<Token>& tokens) {
  const fs::path next = file_.string() + ".next";
  write_whole(next, print_tokens(tokens));
  fs::rename(next, file_);
}

std::string Tokens::create(const std::string& name,
                           Scope scope,
                           const std::optional<std::int64_t>& expires_at,
                           std::int64_t now) {
  const Turn turn(file_);
  auto tokens = all();
  const std::string id = base64_url(random_bytes(id_bytes));
  const std::string secret = base64_url(random_bytes(secret_bytes));
  tokens.push_back({id, name, digest(secret), scope, now, expires_at, {}});
  write(tokens);
  return std::string(prefix) + id + "_" + secret;
}

bool Tokens::revoke(const std::string& id, std::int64_t now) {
  const Turn turn(file_);
  auto tokens = all();
  const auto found = std::ranges::find(tokens, id, &Token::id);
  if (found == tokens.end() || found->revoked_at) return false;
  found->revoked_at = now;
  write(tokens);
  return true;
}

std::optional<Token> Tokens::find(std::string_view authorization) {
  constexpr std::string_view scheme = "bearer ";  // in any case: RFC 9110, 11.1
  constexpr std::size_t id_letters = id_bytes / 3 * 4;
  if (lower_case(authorization.substr(0, scheme.size())) != scheme) return std::nullopt;
  authorization.remove_prefix(scheme.size());
  if (!authorization.starts_with(prefix)) return std::nullopt;
  authorization.remove_prefix(prefix.size());
  if (authorization.size() <= id_letters + 1 || authorization[id_letters] != '_') {
    return std::nullopt;
  }
  const std::string_view id = authorization.substr(0, id_letters);
  const std::string offered = digest(authorization.substr(id_letters + 1));
  for (const Token& token : all()) {
    if (token.id == id && equal_secrets(token.secret_digest, offered)) return token;
  }
  return std::nullopt;
}

}  // namespace repose::server
