/// The schemas of the documents: those written by hand, which live in the program, and those made
/// from the catalogue and the route table.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace repose::server {

/// Path below schemas/ and text of every generated file.
std::vector<std::pair<std::string, std::string>> generated_schemas();

/// File name and text of every schema written by hand.
std::vector<std::pair<std::string, std::string>> written_schemas();

}  // namespace repose::server
