/// Tokens <-> their file, and -> the list that people see, without digests.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/access/tokens.hpp"

namespace repose::server {

std::string print_tokens(const std::vector<Token>& tokens);

/// Nothing where the text is no such file.
std::optional<std::vector<Token>> read_tokens(std::string_view text);

/// {"items":[{"id","name","scope","created_at","expires_at","revoked_at","valid"}]}
std::string print_token_list(const std::vector<Token>& tokens, std::int64_t now);

}  // namespace repose::server
