/// The catalogue as Markdown tables: the reference for people.
#pragma once

#include <string>

namespace repose::server {

std::string catalogue_markdown();

}  // namespace repose::server
