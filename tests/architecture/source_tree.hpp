/// The source tree as text: what the architecture tests read.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace repose::tests {

inline const std::filesystem::path& source_root() {
  static const std::filesystem::path root = REPOSE_SOURCE_DIR;
  return root;
}

struct SourceFile {
  std::string path;  ///< from the root, with slashes: "engine/world.cpp"
  std::string text;
};

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + path.string());
  std::ostringstream text;
  text << stream.rdbuf();
  return std::move(text).str();
}

/// The files below a folder whose names end in one of the given ways, in order of path.
inline std::vector<SourceFile> files_below(std::string_view folder,
                                           const std::vector<std::string_view>& endings) {
  std::vector<SourceFile> result;
  const auto start = source_root() / folder;
  if (!std::filesystem::exists(start)) throw std::runtime_error("no folder " + start.string());
  for (const auto& entry : std::filesystem::recursive_directory_iterator(start)) {
    const auto name = entry.path().filename().string();
    for (const auto ending : endings) {
      if (!entry.is_regular_file() || !name.ends_with(ending)) continue;
      result.push_back({entry.path().lexically_relative(source_root()).generic_string(),
                        read_text(entry.path())});
      break;
    }
  }
  std::sort(result.begin(), result.end(), [](const SourceFile& a, const SourceFile& b) {
    return a.path < b.path;
  });
  return result;
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace repose::tests
