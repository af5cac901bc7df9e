// Who may include whom (house rules 1, 8, 15 and 16): a table, and every #include compared with it.

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/architecture/source_tree.hpp"

namespace repose::tests {

namespace {

// Of the standard library what computes: no files, clock, printing, threads, environment.
const std::set<std::string_view> pure_headers{
    "algorithm",       "array",       "bit",        "bitset",        "cassert",
    "cctype",          "cfloat",      "charconv",   "climits",       "cmath",
    "compare",         "complex",     "concepts",   "cstddef",       "cstdint",
    "cstring",         "deque",       "exception",  "functional",    "initializer_list",
    "iterator",        "limits",      "list",       "map",           "memory",
    "memory_resource", "new",         "numbers",    "numeric",       "optional",
    "queue",           "ranges",      "ratio",      "set",           "span",
    "stack",           "stdexcept",   "stop_token", "string",        "string_view",
    "tuple",           "type_traits", "typeinfo",   "unordered_map", "unordered_set",
    "utility",         "valarray",    "variant",    "vector",        "version",
};

// Sentences with numbers in them: snprintf, in the absence of <format>.
const std::set<std::string_view> text_headers{"cstdio"};

// A store waits for its turn and has a file.
const std::set<std::string_view> store_headers{
    "atomic",
    "cerrno",
    "chrono",
    "condition_variable",
    "filesystem",
    "mutex",
    "shared_mutex",
    "system_error",
};

/// A layer: the folders of ours it may include, and the headers of the standard library.
struct Layer {
  std::string_view folder;
  std::vector<std::string_view> may_include;
  std::vector<const std::set<std::string_view>*> standard;  ///< empty: all of it, and the system's
};

const std::vector<Layer> layers{
    {"engine/", {"engine/"}, {&pure_headers}},
    {"calibrator/", {"calibrator/", "engine/"}, {&pure_headers, &text_headers}},
    {"db/", {"db/"}, {&pure_headers, &store_headers}},
    {"server/", {"server/", "calibrator/", "db/", "engine/"}, {}},
    {"tests/", {"tests/", "server/", "calibrator/", "db/", "engine/"}, {}},
};

/// A library, and the files that may include it: whole paths, or folders and beginnings of names.
struct Library {
  std::string_view header;  ///< how its headers begin
  std::vector<std::string_view> users;
};

const std::vector<Library> libraries{
    {"Eigen/", {"calibrator/", "tests/calibrator/", "tests/support/"}},
    {"unsupported/Eigen/", {"calibrator/"}},
    {"nlopt", {"calibrator/optimiser.cpp"}},
    {"sqlite3", {"db/sqlite.cpp", "db/sqlite.hpp"}},
    {"httplib", {"server/api/http_server.cpp", "tests/"}},
    {"nlohmann/", {"server/json/", "tests/"}},
    {"openssl/", {"server/access/secret.cpp"}},
    {"png", {"server/report/image.cpp"}},
    {"curl/", {"server/webhooks/post.cpp"}},
    {"date/", {"server/nightly/time_zone.cpp"}},
    {"CLI/", {"server/cli"}},
    {"catch2/", {"tests/"}},
    // The operating system's own: a file's lock and name, child processes, terminals.
    {"fcntl.h", {"db/lock.cpp", "db/move.cpp", "server/", "tests/"}},
    {"sys/", {"db/lock.cpp", "server/", "tests/"}},
    {"unistd.h", {"db/lock.cpp", "db/move.cpp", "server/", "tests/"}},
};

struct Include {
  std::string header;
  bool ours;  ///< in quotes
};

std::optional<Include> include_of(std::string_view line) {
  const auto skip = [&] {
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.front()))) {
      line.remove_prefix(1);
    }
  };
  skip();
  if (!line.starts_with('#')) return {};
  line.remove_prefix(1);
  skip();
  if (!line.starts_with("include")) return {};
  line.remove_prefix(7);
  skip();
  if (!line.starts_with('"') && !line.starts_with('<')) return Include{std::string(line), true};
  const bool ours = line.front() == '"';
  line.remove_prefix(1);
  return Include{std::string(line.substr(0, line.find(ours ? '"' : '>'))), ours};
}

bool begins_with_one_of(std::string_view text, const std::vector<std::string_view>& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(), [&](std::string_view beginning) {
    return text.starts_with(beginning);
  });
}

std::string listed(const std::vector<std::string_view>& words) {
  std::string result;
  for (const auto word : words) result.append(result.empty() ? "" : ", ").append(word);
  return result;
}

/// The rule that an include breaks; empty when it breaks none.
std::string broken_rule(std::string_view path, const Include& include) {
  const auto layer = std::find_if(
      layers.begin(), layers.end(), [&](const Layer& l) { return path.starts_with(l.folder); });
  if (layer == layers.end()) return "no layer has this file";
  if (include.ours) {
    if (begins_with_one_of(include.header, layer->may_include)) return {};
    return std::string(layer->folder) + " includes only " + listed(layer->may_include) +
           ", by paths from the root";
  }
  for (const auto& library : libraries) {
    if (!include.header.starts_with(library.header)) continue;
    if (begins_with_one_of(path, library.users)) return {};
    return "this library is for " + listed(library.users) + " alone";
  }
  if (layer->standard.empty()) return {};
  for (const auto* headers : layer->standard) {
    if (headers->contains(include.header)) return {};
  }
  return std::string(layer->folder) +
         " computes: of the standard library only what needs no files, clock, output or threads";
}

/// A line per wrong include: file, line, include, rule.
std::vector<std::string> wrong_includes(const SourceFile& file) {
  std::vector<std::string> result;
  const auto lines = lines_of(file.text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto include = include_of(lines[i]);
    if (!include) continue;
    const auto rule = broken_rule(file.path, *include);
    if (rule.empty()) continue;
    result.push_back(file.path + ":" + std::to_string(i + 1) + ": " + include->header + ": " +
                     rule);
  }
  return result;
}

/// The way by which an include of that library is reached from a file of ours; empty if none is.
std::string way_to(std::string_view library, const std::string& path, std::set<std::string>& seen) {
  if (!seen.insert(path).second) return {};
  for (const auto& line : lines_of(read_text(source_root() / path))) {
    const auto include = include_of(line);
    if (!include) continue;
    if (!include->ours && include->header.starts_with(library)) return path;
    if (!include->ours || !std::filesystem::exists(source_root() / include->header)) continue;
    const auto way = way_to(library, include->header, seen);
    if (!way.empty()) return path + " -> " + way;
  }
  return {};
}

}  // namespace

TEST_CASE("every include points to a layer or library that its file may know", "[architecture]") {
  std::size_t files = 0;
  for (const auto& layer : layers) {
    for (const auto& file : files_below(layer.folder, {".hpp", ".cpp"})) {
      ++files;
      for (const auto& wrong : wrong_includes(file)) FAIL_CHECK(wrong);
    }
  }
  CHECK(files > 50);
}

TEST_CASE("no file of the server reaches the linear algebra through another's header",
          "[architecture]") {
  for (const auto& file : files_below("server/", {".hpp", ".cpp"})) {
    std::set<std::string> seen;
    const auto way = way_to("Eigen/", file.path, seen);
    if (!way.empty()) FAIL_CHECK(way);
  }
  std::set<std::string> seen;
  CHECK(way_to("Eigen/", "calibrator/answer.cpp", seen).ends_with(".hpp"));
}

TEST_CASE("the use cases hand documents on as text: values of JSON stay where they are made",
          "[architecture]") {
  // Beside server/json what prints for people and for other codes.
  const std::vector<std::string_view> users{"server/json/", "server/cli/", "server/exports/"};
  const std::regex value("\\bJson\\b");
  for (const auto& file : files_below("server/", {".hpp", ".cpp"})) {
    if (begins_with_one_of(file.path, users)) continue;
    const auto lines = lines_of(file.text);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (std::regex_search(lines[i], value)) {
        FAIL_CHECK(file.path + ":" + std::to_string(i + 1) + ": " + lines[i]);
      }
    }
  }
}

TEST_CASE("a wrong include is found, with its file, line and rule", "[architecture]") {
  const auto wrong = [](std::string path, std::string text) {
    return wrong_includes({std::move(path), std::move(text)});
  };
  const auto upwards =
      wrong("engine/world.cpp", "#include <vector>\n  # include \"db/store.hpp\"\n");
  REQUIRE(upwards.size() == 1);
  CHECK(upwards[0] ==
        "engine/world.cpp:2: db/store.hpp: engine/ includes only engine/, by paths from the root");

  CHECK(wrong("engine/world.cpp", "#include <iostream>").size() == 1);
  CHECK(wrong("engine/world.cpp", "#include <thread>").size() == 1);
  CHECK(wrong("engine/world.cpp", "#include <chrono>").size() == 1);
  CHECK(wrong("engine/world.cpp", "#include <unistd.h>").size() == 1);
  CHECK(wrong("engine/world.cpp", "#include \"world.hpp\"").size() == 1);
  CHECK(wrong("engine/world.cpp", "#include MADE_UP").size() == 1);
  CHECK(wrong("calibrator/fit.hpp", "#include \"server/service.hpp\"").size() == 1);
  CHECK(wrong("calibrator/surrogate.cpp", "#include <nlopt.hpp>").size() == 1);
  CHECK(wrong("db/store.cpp", "#include <sqlite3.h>").size() == 1);
  CHECK(wrong("db/store.cpp", "#include \"engine/unit.hpp\"").size() == 1);
  CHECK(wrong("db/store.cpp", "#include <fcntl.h>").size() == 1);
  CHECK(wrong("server/service.cpp", "#include <nlohmann/json.hpp>").size() == 1);
  CHECK(wrong("server/service.cpp", "#include <httplib.h>").size() == 1);
  CHECK(wrong("server/service.cpp", "#include <catch2/catch.hpp>").size() == 1);
  CHECK(wrong("helpers/string.cpp", "#include <string>").size() == 1);

  CHECK(wrong("engine/world.cpp", "#include <cmath>\n#include \"engine/unit.hpp\"").empty());
  CHECK(wrong("calibrator/surrogate.cpp", "#include <Eigen/Dense>").empty());
  CHECK(wrong("db/sqlite.cpp", "#include <sqlite3.h>").empty());
  CHECK(wrong("server/service.cpp", "#include <thread>\n#include \"db/store.hpp\"").empty());
  CHECK(wrong("engine/world.cpp", "// #include <iostream>\nint include;").empty());
}

}  // namespace repose::tests
