// Kept inputs of the fuzz targets, and as many near them as time allows.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include <catch2/catch.hpp>

#include "tests/fuzz/targets.hpp"

namespace {

namespace fs = std::filesystem;
using namespace repose::tests;

std::vector<std::string> corpus(std::string_view folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(REPOSE_SOURCE_DIR) / folder)) {
    if (entry.is_regular_file()) paths.push_back(entry.path());
  }
  std::ranges::sort(paths);
  std::vector<std::string> texts;
  for (const auto& path : paths) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    texts.push_back(text.str());
  }
  return texts;
}

/// Bytes changed, cut out, doubled, and pieces of another put in.
std::string changed(std::string text, const std::string& other, std::mt19937_64& random) {
  const auto below = [&random](std::size_t limit) { return limit == 0 ? 0 : random() % limit; };
  for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
    const std::size_t at = below(text.size() + 1);
    const std::size_t length = below(std::min<std::size_t>(16, text.size() - at) + 1);
    switch (below(4)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(random());
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(at, length));
        break;
      default:
        text.insert(at, other.substr(below(other.size() + 1), below(32)));
    }
  }
  return text;
}

/// How many are made of each kept input: REPOSE_FUZZ asks for more.
int rounds() {
  const char* asked = std::getenv("REPOSE_FUZZ");
  return asked == nullptr ? 40 : std::max(1, std::atoi(asked));
}

}  // namespace

TEST_CASE("no input crashes a reader, and what it reads and prints is the same again", "[server]") {
  std::mt19937_64 random(20261129);
  for (const FuzzTarget& target : fuzz_targets) {
    const auto kept = corpus(target.kept);
    REQUIRE(kept.size() >= 3);
    for (const std::string& text : kept) {
      INFO(target.kept << ": " << text);
      CHECK_NOTHROW(target.run(text));
      for (int i = 0; i < rounds(); ++i) {
        const std::string near = changed(text, kept[random() % kept.size()], random);
        INFO(near);
        CHECK_NOTHROW(target.run(near));
      }
    }
  }
}
