/// The kept examples of documents, schemas/examples.
#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace repose::tests {

/// By its place there: "valid/drop-minimal.json".
inline std::string example(const std::string& name) {
  std::ifstream file(REPOSE_SOURCE_DIR "/schemas/examples/" + name);
  if (!file) throw std::runtime_error("there is no example " + name);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace repose::tests
