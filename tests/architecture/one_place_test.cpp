// One effect, one file, one line; one experiment, one file, one line; a name is written once (house
// rules 2 and 3).

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/architecture/source_tree.hpp"

namespace repose::tests {

namespace {

const SourceFile& effect_list() {
  static const SourceFile file{"engine/effects/all.hpp",
                               read_text(source_root() / "engine/effects/all.hpp")};
  return file;
}

std::vector<SourceFile> effect_files() {
  auto files = files_below("engine/effects", {".hpp"});
  std::erase_if(files, [](const SourceFile& file) { return file.path == effect_list().path; });
  return files;
}

/// "engine/effects/size_spread.hpp" -> "size_spread".
std::string stem_of(const SourceFile& file) {
  return std::filesystem::path(file.path).stem().string();
}

/// "size_spread" -> "SizeSpread".
std::string type_name(std::string_view stem) {
  std::string result;
  bool capital = true;
  for (const char letter : stem) {
    if (letter != '_') {
      const auto code = static_cast<unsigned char>(letter);
      result += static_cast<char>(capital ? std::toupper(code) : code);
    }
    capital = letter == '_';
  }
  return result;
}

/// The first place of a word that stands alone, from a place on.
std::size_t find_word(const std::string& text, const std::string& word, std::size_t from = 0) {
  const auto in_word = [&](std::size_t i) {
    return i < text.size() &&
           (std::isalnum(static_cast<unsigned char>(text[i])) != 0 || text[i] == '_');
  };
  for (auto at = text.find(word, from); at != std::string::npos; at = text.find(word, at + 1)) {
    if ((at == 0 || !in_word(at - 1)) && !in_word(at + word.size())) return at;
  }
  return std::string::npos;
}

bool has_word(const std::string& text, const std::string& word) {
  return find_word(text, word) != std::string::npos;
}

/// What stands between the angle brackets of AllEffects.
std::string tuple_of(const std::string& list) {
  const auto begin = list.find("using AllEffects");
  if (begin == std::string::npos) return {};
  return list.substr(begin, list.find(';', begin) - begin);
}

/// What the list lacks of an effect's file; empty when nothing.
std::string not_listed(const std::string& stem, const std::string& list) {
  if (list.find("#include \"engine/effects/" + stem + ".hpp\"") == std::string::npos) {
    return "does not include engine/effects/" + stem + ".hpp";
  }
  if (!has_word(tuple_of(list), type_name(stem)))
    return "has no " + type_name(stem) + " in AllEffects";
  return {};
}

/// The name in an effect's text: .name = "size_spread".
std::string name_of(const SourceFile& effect) {
  const std::string key = ".name = \"";
  const auto text = effect.text.find("EffectText text");
  const auto begin = effect.text.find(key, text == std::string::npos ? effect.text.size() : text);
  if (begin == std::string::npos) return {};
  const auto start = begin + key.size();
  return effect.text.substr(start, effect.text.find('"', start) - start);
}

/// The files that spell a name as a whole string. An observable is another thing, whatever its
/// name.
std::vector<std::string> spelled_in(const std::string& name, const std::vector<SourceFile>& files) {
  const std::string spelled = '"' + name + '"';
  std::vector<std::string> result;
  for (const auto& file : files) {
    for (auto at = file.text.find(spelled); at != std::string::npos;
         at = file.text.find(spelled, at + 1)) {
      std::string before = file.text.substr(0, at);
      while (!before.empty() && std::isspace(static_cast<unsigned char>(before.back())) != 0) {
        before.pop_back();
      }
      if (before.ends_with("ObservableInfo{")) continue;
      result.push_back(file.path);
      break;
    }
  }
  return result;
}

}  // namespace

TEST_CASE("every effect's file is in the list of effects", "[architecture]") {
  const auto files = effect_files();
  CHECK(files.size() >= 5);
  for (const auto& file : files) {
    const auto missing = not_listed(stem_of(file), effect_list().text);
    if (!missing.empty()) FAIL_CHECK(effect_list().path + " " + missing);
    if (!has_word(file.text, "struct " + type_name(stem_of(file)))) {
      FAIL_CHECK(file.path + " holds no struct " + type_name(stem_of(file)));
    }
    if (name_of(file) != stem_of(file)) {
      FAIL_CHECK(file.path + " names its effect '" + name_of(file) + "'");
    }
  }
}

TEST_CASE("every experiment's file is in the list of experiments", "[architecture]") {
  const auto list = read_text(source_root() / "engine/experiments/all.hpp");
  const auto files = files_below("engine/experiments", {".cpp"});
  CHECK(files.size() >= 3);
  for (const auto& file : files) {
    const auto name = stem_of(file);
    if (!has_word(list, "extern const ExperimentInfo " + name)) {
      FAIL_CHECK("engine/experiments/all.hpp does not declare " + name + ", which is in " +
                 file.path);
    }
    if (!has_word(list, "experiments::" + name)) {
      FAIL_CHECK("engine/experiments/all.hpp does not list experiments::" + name);
    }
  }
}

TEST_CASE("an effect's name is written in its own file and nowhere else", "[architecture]") {
  std::vector<SourceFile> sources;
  for (const auto* layer : {"engine", "calibrator", "db", "server"}) {
    for (auto& file : files_below(layer, {".hpp", ".cpp", ".sql", ".html", ".js", ".css"})) {
      sources.push_back(std::move(file));
    }
  }
  for (const auto& effect : effect_files()) {
    for (const auto& path : spelled_in(name_of(effect), sources)) {
      if (path != effect.path) {
        FAIL_CHECK(path + " spells \"" + name_of(effect) + "\", which belongs to " + effect.path);
      }
    }
  }
}

TEST_CASE("an effect outside the list and a name spelled twice are found", "[architecture]") {
  const std::string list =
      "#include \"engine/effects/air_drag.hpp\"\n"
      "using AllEffects = std::tuple<effects::AirDragger>;\n";
  CHECK(not_listed("jkr_adhesion", list) == "does not include engine/effects/jkr_adhesion.hpp");
  CHECK(not_listed("air_drag", list) == "has no AirDrag in AllEffects");
  const std::string good =
      "#include \"engine/effects/air_drag.hpp\"\n"
      "using AllEffects = std::tuple<effects::AirDrag>;\n";
  CHECK(not_listed("air_drag", good).empty());

  const SourceFile effect{"engine/effects/air_drag.hpp",
                          "static constexpr EffectText text{\n  .name = \"air_drag\",\n};"};
  CHECK(name_of(effect) == "air_drag");
  CHECK(name_of({"", "nothing"}).empty());
  const SourceFile second{"server/report/words.cpp", "f(\"air_drag\");"};
  const SourceFile longer{"server/cli.cpp", "f(\"air_drags\", \"air_drag.number\"); // air_drag"};
  const SourceFile observed{"engine/experiments/fan.cpp",
                            "ObservableInfo{\"air_drag\", unit::one}"};
  CHECK(spelled_in("air_drag", {effect, second, longer, observed}) ==
        std::vector<std::string>{effect.path, second.path});
}

}  // namespace repose::tests
