// House rule 10: the loop of every effect over the contacts of a block becomes vector code. The
// witness is g++ itself.

#include <cstdio>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <sys/wait.h>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/architecture/source_tree.hpp"

namespace repose::tests {

namespace {

/// Effects whose loop may stay scalar, each with its reason.
const std::map<std::string_view, std::string_view> exemptions{};

struct Compilation {
  int status = -1;
  std::string report;
};

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char letter : text) result += letter == '\'' ? "'\\''" : std::string(1, letter);
  return result + "'";
}

/// Compiles a source for a processor with vectors of 32 bytes, as the build does, and keeps what
/// g++ says.
Compilation compile(const std::string& source) {
  const std::string command =
      "cd " + quoted(source_root().string()) + " && " + quoted(REPOSE_COMPILER) +
      " " REPOSE_ENGINE_FLAGS " -std=c++20 -march=x86-64-v3 -fopt-info-vec-optimized -I. -c " +
      quoted(source) + " -o /dev/null 2>&1";
  Compilation result;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return result;
  char buffer[4096];
  while (const auto size = std::fread(buffer, 1, sizeof buffer, pipe)) {
    result.report.append(buffer, size);
  }
  const int status = pclose(pipe);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

using Place = std::pair<std::string, int>;  // file and line, from 1

/// The loops that a report of g++ names: "engine/effects/x.hpp:61:23: optimized: loop vectorized
/// using".
std::set<Place> vectorised_loops(const std::string& report) {
  std::set<Place> result;
  for (const auto& line : lines_of(report)) {
    if (line.find("optimized: loop vectorized") == std::string::npos) continue;
    const auto colon = line.find(':');
    std::string file = line.substr(0, colon);
    if (file.starts_with("./")) file.erase(0, 2);
    result.emplace(file, std::stoi(line.substr(colon + 1)));
  }
  return result;
}

/// The lines of the `for` loops of the functions that begin with a text, up to their closing
/// braces.
std::vector<int> loop_lines(const std::string& text, std::string_view beginning) {
  std::vector<int> result;
  int depth = 0;
  bool inside = false;
  const auto lines = lines_of(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto& line = lines[i];
    if (!inside && line.find(beginning) != std::string::npos) {
      inside = true;
      depth = 0;
    }
    if (!inside) continue;
    if (line.find("for (") != std::string::npos) result.push_back(static_cast<int>(i) + 1);
    for (const char letter : line) {
      if (letter == '{') ++depth;
      if (letter == '}' && --depth == 0) inside = false;
    }
  }
  return result;
}

}  // namespace

TEST_CASE("g++ vectorises the contact loop of every effect", "[architecture][slow]") {
  const auto compilation = compile("engine/contact_model.cpp");
  INFO(compilation.report);
  REQUIRE(compilation.status == 0);
  const auto vectorised = vectorised_loops(compilation.report);
  int loops = 0;
  for (const auto& file : files_below("engine/effects", {".hpp"})) {
    const auto stem = std::filesystem::path(file.path).stem().string();
    const auto lines = loop_lines(file.text, "static void contact(");
    if (lines.empty() && file.text.find(" contact(") != std::string::npos) {
      FAIL_CHECK(file.path + ": no loop found in contact()");
    }
    for (const int line : lines) {
      ++loops;
      const bool fast = vectorised.contains({file.path, line});
      const bool exempt = exemptions.contains(stem);
      if (!fast && !exempt) FAIL_CHECK(file.path + ":" + std::to_string(line) + ": not vectorised");
      if (fast && exempt) FAIL_CHECK(stem + " needs no exemption any more");
    }
  }
  CHECK(loops >= 4);
}

TEST_CASE("g++ vectorises what all contacts go through", "[architecture][slow]") {
  const auto compilation = compile("engine/contact_model.cpp");
  REQUIRE(compilation.status == 0);
  const auto vectorised = vectorised_loops(compilation.report);
  const auto text = read_text(source_root() / "engine/contact_model.cpp");
  for (const auto* function : {"void kinematics(", "void hertz("}) {
    const auto lines = loop_lines(text, function);
    CHECK_FALSE(lines.empty());
    for (const int line : lines) {
      INFO(function << " line " << line);
      CHECK(vectorised.contains({"engine/contact_model.cpp", line}));
    }
  }
}

TEST_CASE("a loop that stays scalar is found", "[architecture]") {
  const std::string text =
      "static void contact(Block& c,\n"
      "                    double dt) {\n"
      "  for (int i = 0; i < 64; ++i) {\n"
      "    c.x[i] = c.x[i - 1];\n"
      "  }\n"
      "}\n"
      "void other() { for (;;) {} }\n";
  CHECK(loop_lines(text, "static void contact(") == std::vector<int>{3});
  const auto loops = vectorised_loops(
      "./engine/effects/x.hpp:3:21: optimized: loop vectorized using 32 byte vectors\n"
      "engine/effects/y.hpp:4:1: optimized: basic block part vectorized using 32 byte vectors\n");
  CHECK(loops == std::set<Place>{{"engine/effects/x.hpp", 3}});
}

}  // namespace repose::tests
