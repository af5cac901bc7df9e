/// Checks a document against a schema: the part of JSON Schema draft 7 that ours use.
#pragma once

#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace repose::tests {

using Json = nlohmann::ordered_json;

/// What is wrong, each with its pointer; nothing where the document conforms. A keyword that is not
/// known here is reported too: a check that does nothing would pass for one that passed.
std::vector<std::string> violations(const Json& schema, const Json& document);

/// The same for a schema within a larger document, in which its references lead.
std::vector<std::string> violations(const Json& root, const Json& schema, const Json& document);

/// For CHECK_THAT, which shows what is wrong: nothing is.
inline auto conforms() {
  static const std::vector<std::string> nothing;  // the matcher keeps a reference
  return Catch::Equals(nothing);
}

}  // namespace repose::tests
