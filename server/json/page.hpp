/// Page: a part of a list, as a document, and where the part after it begins.
#pragma once

#include <string>

namespace repose::server {

struct Page {
  std::string document;  ///< {"items":[...],"next"}; `next` is null at the end
  std::string next;      ///< the same, as a query has it; empty at the end
};

}  // namespace repose::server
