/// Letters of protocols and tables: ASCII alone, whatever the language of the machine.
#pragma once

#include <string>
#include <string_view>

namespace repose::server {

char lower_case(char letter);
std::string lower_case(std::string_view text);

/// Without the blanks and tabs at its ends.
std::string_view trimmed(std::string_view text);

}  // namespace repose::server
