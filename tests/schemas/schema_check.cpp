#include "tests/schemas/schema_check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace repose::tests {

namespace {

/// One document against one schema.
class Check {
 public:
  Check(const Json& root, std::vector<std::string>& wrong) : root_(root), wrong_(wrong) {}

  void run(const Json& schema, const Json& value, const std::string& at) {
    for (const auto& [keyword, rule] : schema.items()) {
      const auto known = rules.find(keyword);
      if (known == rules.end()) {
        complain(at, "a keyword is not checked: ", keyword);
      } else if (known->second != nullptr && !(this->*known->second)(schema, rule, value, at)) {
        complain(at, keyword, rule.dump());
      }
    }
  }

 private:
  void complain(const std::string& at, const std::string& what, const std::string& rule) {
    std::string text = at;
    text.append(": ").append(what).append(" ").append(rule);
    wrong_.push_back(std::move(text));
  }

  /// The pointer to a member.
  static std::string below(const std::string& at, const std::string& name) {
    std::string text = at;
    text.append("/").append(name);
    return text;
  }

  using Rule = bool (Check::*)(const Json&, const Json&, const Json&, const std::string&);
  static const std::map<std::string, Rule> rules;

  [[nodiscard]] bool conforms(const Json& schema, const Json& value) const {
    std::vector<std::string> ignored;
    Check(root_, ignored).run(schema, value, "");
    return ignored.empty();
  }

  static bool is_of(const std::string& type, const Json& value) {
    if (type == "integer") {
      return value.is_number() && value.get<double>() == std::floor(value.get<double>());
    }
    if (type == "number") return value.is_number();
    return type == value.type_name();
  }

  bool type(const Json&, const Json& rule, const Json& value, const std::string&) {
    if (rule.is_string()) return is_of(rule.get<std::string>(), value);
    return std::ranges::any_of(
        rule, [&](const Json& each) { return is_of(each.get<std::string>(), value); });
  }
  bool reference(const Json&, const Json& rule, const Json& value, const std::string& at) {
    run(root_.at(Json::json_pointer(rule.get<std::string>().substr(1))), value, at);
    return true;
  }
  bool constant(const Json&, const Json& rule, const Json& value, const std::string&) {
    return value == rule;
  }
  bool one_of_values(const Json&, const Json& rule, const Json& value, const std::string&) {
    return std::ranges::find(rule, value) != rule.end();
  }
  bool one_of(const Json&, const Json& rule, const Json& value, const std::string&) {
    return std::ranges::count_if(rule, [&](const Json& s) { return conforms(s, value); }) == 1;
  }
  bool any_of(const Json&, const Json& rule, const Json& value, const std::string&) {
    return std::ranges::any_of(rule, [&](const Json& s) { return conforms(s, value); });
  }
  bool required(const Json&, const Json& rule, const Json& value, const std::string&) {
    return !value.is_object() || std::ranges::all_of(rule, [&](const Json& name) {
      return value.contains(name.get<std::string>());
    });
  }
  bool properties(const Json&, const Json& rule, const Json& value, const std::string& at) {
    if (!value.is_object()) return true;
    for (const auto& [name, schema] : rule.items()) {
      if (value.contains(name)) run(schema, value.at(name), below(at, name));
    }
    return true;
  }
  bool others(const Json& schema, const Json& rule, const Json& value, const std::string& at) {
    if (!value.is_object()) return true;
    const Json known = schema.value("properties", Json::object());
    for (const auto& [name, member] : value.items()) {
      if (known.contains(name)) continue;
      if (rule.is_boolean() && !rule.get<bool>()) return false;
      if (rule.is_object()) run(rule, member, below(at, name));
    }
    return true;
  }
  bool items(const Json&, const Json& rule, const Json& value, const std::string& at) {
    if (!value.is_array()) return true;
    for (std::size_t i = 0; i < value.size(); ++i) {
      run(rule, value[i], below(at, std::to_string(i)));
    }
    return true;
  }
  bool unique(const Json&, const Json&, const Json& value, const std::string&) {
    for (std::size_t i = 0; value.is_array() && i < value.size(); ++i) {
      if (std::count(value.begin(), value.end(), value[i]) > 1) return false;
    }
    return true;
  }

  template <class Holds>
  static bool size(const Json& value, bool counted, const Json& rule, Holds holds) {
    const std::size_t count = value.is_string() ? value.get<std::string>().size() : value.size();
    return !counted || holds(count, rule.get<std::size_t>());
  }
  bool min_items(const Json&, const Json& rule, const Json& value, const std::string&) {
    return size(value, value.is_array(), rule, std::greater_equal<>{});
  }
  bool max_items(const Json&, const Json& rule, const Json& value, const std::string&) {
    return size(value, value.is_array(), rule, std::less_equal<>{});
  }
  bool min_length(const Json&, const Json& rule, const Json& value, const std::string&) {
    return size(value, value.is_string(), rule, std::greater_equal<>{});
  }
  bool max_length(const Json&, const Json& rule, const Json& value, const std::string&) {
    return size(value, value.is_string(), rule, std::less_equal<>{});
  }
  bool minimum(const Json&, const Json& rule, const Json& value, const std::string&) {
    return !value.is_number() || value >= rule;
  }
  bool maximum(const Json&, const Json& rule, const Json& value, const std::string&) {
    return !value.is_number() || value <= rule;
  }
  bool above(const Json&, const Json& rule, const Json& value, const std::string&) {
    return !value.is_number() || value > rule;
  }

  const Json& root_;
  std::vector<std::string>& wrong_;
};

const std::map<std::string, Check::Rule> Check::rules{
    {"$schema", nullptr},
    {"$id", nullptr},
    {"$comment", nullptr},
    {"title", nullptr},
    {"description", nullptr},
    {"default", nullptr},
    {"definitions", nullptr},
    {"$ref", &Check::reference},
    {"type", &Check::type},
    {"const", &Check::constant},
    {"enum", &Check::one_of_values},
    {"oneOf", &Check::one_of},
    {"anyOf", &Check::any_of},
    {"required", &Check::required},
    {"properties", &Check::properties},
    {"additionalProperties", &Check::others},
    {"items", &Check::items},
    {"uniqueItems", &Check::unique},
    {"minItems", &Check::min_items},
    {"maxItems", &Check::max_items},
    {"minLength", &Check::min_length},
    {"maxLength", &Check::max_length},
    {"minimum", &Check::minimum},
    {"maximum", &Check::maximum},
    {"exclusiveMinimum", &Check::above},
};

}  // namespace

std::vector<std::string> violations(const Json& root, const Json& schema, const Json& document) {
  std::vector<std::string> wrong;
  Check(root, wrong).run(schema, document, "");
  return wrong;
}

std::vector<std::string> violations(const Json& schema, const Json& document) {
  return violations(schema, schema, document);
}

}  // namespace repose::tests
