/// ParameterSet: the numbers of one model, sparse and ordered. An absent parameter is at its null
/// value, so which effects are on is never stored, only derived.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/material.hpp"

namespace repose::engine {

/// Which number: a field "effect.parameter" or "material.property", and between which materials:
/// none for a global one, one for a material's property, two (in ascending order) for a pair's.
struct ParameterKey {
  std::string field;
  std::vector<MaterialId> between;

  auto operator<=>(const ParameterKey&) const = default;
};

/// The key with `between` in its canonical order.
ParameterKey make_key(std::string_view field, std::vector<MaterialId> between);

/// "sliding_friction.coefficient:grain-wall"; the part after the colon only where there is one.
std::string to_string(const ParameterKey& key);

class ParameterSet {
 public:
  void set(const ParameterKey& key, double value) { values_[key] = value; }  ///< SI
  void erase(const ParameterKey& key) { values_.erase(key); }
  [[nodiscard]] std::optional<double> get(const ParameterKey& key) const;
  [[nodiscard]] double get_or(const ParameterKey& key, double otherwise) const {
    return get(key).value_or(otherwise);
  }

  [[nodiscard]] auto begin() const { return values_.begin(); }
  [[nodiscard]] auto end() const { return values_.end(); }
  [[nodiscard]] bool empty() const { return values_.empty(); }
  [[nodiscard]] std::size_t size() const { return values_.size(); }

  bool operator==(const ParameterSet&) const = default;

 private:
  std::map<ParameterKey, double> values_;
};

}  // namespace repose::engine
