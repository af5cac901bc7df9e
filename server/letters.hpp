/// Letters of protocols and tables: ASCII alone, whatever the language of the machine.
#pragma once

#include <string>
#include <string_view>

namespace repose::server {

char lower_case(char letter);
std::string lower_case(std::string_view text);
/// A heading in the midst of a sentence; JKR stays JKR.
std::string lower_first(std::string text);

/// Without the blanks and tabs at its ends.
std::string_view trimmed(std::string_view text);

/// Whether the bytes are letters in UTF-8 (RFC 3629): no overlong form, no surrogate.
bool is_utf8(std::string_view text);

/// Whether there is a control character of ASCII or of Latin-1 (in UTF-8): on a terminal or in a
/// list of lines it would not be what it stands for.
bool has_control_letter(std::string_view text);
/// The same with a blank in the place of each.
std::string without_control_letters(std::string_view text);

}  // namespace repose::server
