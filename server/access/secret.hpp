/// Digests, signatures and random bytes: OpenSSL's header is included here alone.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace repose::server {

/// SHA-256 in hexadecimal.
std::string digest(std::string_view text);

/// HMAC-SHA256 (RFC 2104) of a text, as bytes.
std::string signature(std::string_view secret, std::string_view text);

/// So many bytes that nobody can guess.
std::string random_bytes(std::size_t count);

/// RFC 4648: the usual letters with padding, and those for addresses without.
std::string base64(std::string_view bytes);
std::string base64_url(std::string_view bytes);
/// The bytes of a padded text in the usual letters; empty where it is none.
std::string from_base64(std::string_view text);

/// Whether they are equal, in a time that depends on their lengths alone.
bool equal_secrets(std::string_view a, std::string_view b);

}  // namespace repose::server
