// The top level of the tree is fixed: a new name there is a decision, not an accident.

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/architecture/source_tree.hpp"

namespace repose::tests {

namespace {

const std::set<std::string_view> allowed_names{
    "CMakeLists.txt",
    "LICENSE",
    "README.md",
    "calibrator",
    "db",
    "engine",
    "repose",
    "schemas",
    "server",
    "tests",
};

/// Whether a name is what a line of .gitignore means: `*` stands for any letters, a last / for a
/// folder.
bool matches(std::string_view pattern, std::string_view name) {
  if (pattern.ends_with('/')) pattern.remove_suffix(1);
  if (pattern.empty()) return name.empty();
  if (pattern.front() == '*') {
    for (std::size_t i = 0; i <= name.size(); ++i) {
      if (matches(pattern.substr(1), name.substr(i))) return true;
    }
    return false;
  }
  return !name.empty() && name.front() == pattern.front() &&
         matches(pattern.substr(1), name.substr(1));
}

}  // namespace

TEST_CASE("the top level holds the names agreed on and no others", "[architecture]") {
  const auto ignored = lines_of(read_text(source_root() / ".gitignore"));
  for (const auto& entry : std::filesystem::directory_iterator(source_root())) {
    const auto name = entry.path().filename().string();
    bool expected = name.starts_with('.') || allowed_names.contains(name);
    for (const auto& pattern : ignored) expected = expected || matches(pattern, name);
    if (!expected) FAIL_CHECK("'" + name + "' does not belong at the top level");
  }
  for (const auto name : allowed_names) {
    if (!std::filesystem::exists(source_root() / name))
      FAIL_CHECK(std::string(name) + " is missing");
  }
}

TEST_CASE("a pattern of .gitignore means what git takes it to mean", "[architecture]") {
  CHECK(matches("build/", "build"));
  CHECK(matches("build-*/", "build-asan"));
  CHECK(matches("*.db", "studies.db"));
  CHECK_FALSE(matches("build/", "builder"));
  CHECK_FALSE(matches("*.db", "db"));
}

}  // namespace repose::tests
