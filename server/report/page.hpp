/// Page: the parts that every report's HTML is made of.
#pragma once

#include <string>
#include <string_view>

namespace repose::server {

/// <name class="style">words</name>, the words escaped.
std::string element(std::string_view name, std::string_view words, std::string_view style = {});

/// A cell of a table; its column's head stands with it where the page is too narrow for columns.
std::string cell(std::string_view head, std::string_view words, std::string_view style = {});

/// A term of a list and what it stands for.
std::string described(std::string_view term, std::string_view what);

/// From the first letter of the file to where the content begins; the style sheet is in it.
std::string page_head(std::string_view title);
inline constexpr std::string_view page_foot = "</main>\n</body>\n</html>\n";

}  // namespace repose::server
