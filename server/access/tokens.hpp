/// Tokens: who may use the service, and for what. They live in a file beside the database, which
/// `repose token` changes and a running service reads anew when it has changed. A secret is shown
/// once, when it is made, and kept as its SHA-256: 256 random bits need no slower hash.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace repose::server {

/// What a request needs and a token gives; each includes those before it.
enum class Scope {
  nothing,  ///< anyone may
  read,
  submit,  ///< also start, cancel and keep
  admin,   ///< also what concerns other users
};
inline constexpr std::array<std::string_view, 4> scope_names{"nothing", "read", "submit", "admin"};

struct Token {
  std::string id;
  std::string name;  ///< whose
  std::string secret_digest;
  Scope scope = Scope::read;
  std::int64_t created_at = 0;  ///< microseconds since 1970 UTC, as the others
  std::optional<std::int64_t> expires_at = {};
  std::optional<std::int64_t> revoked_at = {};
};

/// What a token is good for at that time; nothing where it has expired or was revoked.
Scope scope_at(const Token& token, std::int64_t now);

class Tokens {
 public:
  /// The file of the tokens that belong to a database.
  static std::filesystem::path file_for(const std::filesystem::path& database);

  explicit Tokens(std::filesystem::path file) : file_(std::move(file)) {}

  /// All that were ever made. Throws std::runtime_error where the file cannot be read, or is not
  /// there any more after it has been: then nobody gets in.
  std::vector<Token> all();

  /// Makes one; what comes back is what its user sends, and is not to be had again.
  std::string create(const std::string& name,
                     Scope scope,
                     const std::optional<std::int64_t>& expires_at,
                     std::int64_t now);
  /// False where there is none of that id, or it was revoked before.
  bool revoke(const std::string& id, std::int64_t now);

  /// The token that a field "Authorization: Bearer ..." holds; nothing where it is not known.
  std::optional<Token> find(std::string_view authorization);

 private:
  void write(const std::vector<Token>& tokens);

  std::filesystem::path file_;
  std::mutex mutex_;
  std::filesystem::file_time_type read_at_{};
  std::uintmax_t read_size_ = 0;
  std::vector<Token> tokens_;  ///< as last read; a file that can be read holds some
};

}  // namespace repose::server
