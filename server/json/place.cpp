#include "server/json/place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace repose::server {

namespace {

/// The first bytes of a text, cut between characters.
std::string beginning(const std::string& text, std::size_t longest) {
  if (text.size() <= longest) return text;
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + "...";
}

/// Smallest number of letters to insert, take out or replace (Levenshtein 1966).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row[b.size()];
}

template <class Name>
std::string list(std::span<const Name> names) {
  std::string text;
  for (const Name& name : names) {
    if (!text.empty()) text += ", ";
    text += name;
  }
  return text;
}

template <class Name>
std::string suggestion(std::string_view word, std::span<const Name> names) {
  constexpr std::size_t longest = 64;  // no name is longer; the table grows with the square
  if (word.size() > longest) return "";
  std::size_t nearest = std::max<std::size_t>(2, word.size() / 3) + 1;
  std::string_view best;
  for (const Name& name : names) {
    const std::size_t distance = edit_distance(word, name);
    if (distance < nearest) {
      nearest = distance;
      best = name;
    }
  }
  return best.empty() ? "" : " (did you mean \"" + std::string(best) + "\"?)";
}

/// The whole number that a number is, where it is one of ours: 4, but 4.0 and 4e2 as well. Beyond
/// 2^53 a number with a point or an exponent no longer says which whole number is meant.
std::optional<std::int64_t> whole_number(const Json& json) {
  constexpr double most_exact = 9007199254740992.0;
  if (json.is_number_unsigned()) {
    const auto value = json.get<std::uint64_t>();
    constexpr std::uint64_t most = std::numeric_limits<std::int64_t>::max();
    return value <= most ? std::optional(static_cast<std::int64_t>(value)) : std::nullopt;
  }
  if (json.is_number_integer()) return json.get<std::int64_t>();
  if (!json.is_number_float()) return std::nullopt;
  const auto value = json.get<double>();
  if (value != std::floor(value) || std::abs(value) > most_exact) return std::nullopt;
  return static_cast<std::int64_t>(value);
}

}  // namespace

std::string listed(std::span<const std::string_view> names) { return list(names); }
std::string listed(std::span<const std::string> names) { return list(names); }

std::string did_you_mean(std::string_view word, std::span<const std::string_view> names) {
  return suggestion(word, names);
}
std::string did_you_mean(std::string_view word, std::span<const std::string> names) {
  return suggestion(word, names);
}

std::string Place::found() const {
  constexpr std::size_t longest = 80;
  if (!exists()) return "nothing";
  switch (json().type()) {
    case Json::value_t::object:
      return "an object";
    case Json::value_t::array:
      return "an array of " + std::to_string(json().size());
    case Json::value_t::string:
      return "\"" + beginning(json().get_ref<const std::string&>(), longest) + "\"";
    default:
      return to_text(json());
  }
}

void Place::complain(std::string message, std::string allowed) const {
  complain(std::move(message), found(), std::move(allowed));
}

void Place::complain(std::string message, std::string found_instead, std::string allowed) const {
  problems_->add({pointer_, std::move(message), std::move(found_instead), std::move(allowed)});
}

std::optional<double> Place::number() const {
  if (exists() && json().is_number()) return json().get<double>();
  complain("a number is expected here", "a number");
  return std::nullopt;
}

std::optional<std::int64_t> Place::whole(std::int64_t least, std::int64_t most) const {
  const auto value = exists() ? whole_number(json()) : std::nullopt;
  if (value && *value >= least && *value <= most) return value;
  complain("a whole number in its bounds is expected here",
           std::to_string(least) + " to " + std::to_string(most));
  return std::nullopt;
}

std::optional<std::uint64_t> Place::seed() const {
  if (exists() && json().is_number_unsigned()) return json().get<std::uint64_t>();
  complain("a seed is a whole number", "0 to 18446744073709551615");
  return std::nullopt;
}

std::optional<bool> Place::truth() const {
  if (exists() && json().is_boolean()) return json().get<bool>();
  complain("this is said by true or false", "true or false");
  return std::nullopt;
}

std::optional<std::string> Place::text(std::size_t longest) const {
  if (exists() && json().is_string()) {
    const auto& text = json().get_ref<const std::string&>();
    if (text.size() <= longest) return text;
  }
  complain("a text is expected here", "a text of at most " + std::to_string(longest) + " bytes");
  return std::nullopt;
}

std::optional<std::size_t> Place::one_of(std::span<const std::string_view> names,
                                         std::string_view kind) const {
  std::string hint;
  if (exists() && json().is_string()) {
    const auto& text = json().get_ref<const std::string&>();
    const auto at = std::ranges::find(names, std::string_view(text));
    if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
    hint = did_you_mean(text, names);
  }
  complain("this is no " + std::string(kind) + hint, listed(names));
  return std::nullopt;
}

std::vector<Place> Place::elements() const {
  std::vector<Place> result;
  if (!exists()) return result;
  if (!json().is_array()) {
    complain("an array is expected here", "an array");
    return result;
  }
  for (std::size_t i = 0; i < json().size(); ++i) {
    result.emplace_back(&json()[i], pointer_to(pointer_, i), *problems_);
  }
  return result;
}

Members::Members(const Place& place)
    : place_(place), object_(place.exists() && place.json().is_object()) {
  if (place.exists() && !object_) place.complain("an object is expected here", "an object");
}

Place Members::optional(std::string_view name) {
  asked_.emplace_back(name);
  const Json* value = nullptr;
  if (object_) {
    const auto found = place_.json().find(name);
    if (found != place_.json().end()) value = &*found;
  }
  return {value, pointer_to(place_.pointer(), name), place_.problems()};
}

Place Members::required(std::string_view name, std::string_view what_to_write) {
  Place member = optional(name);
  if (object_ && !member.exists()) {
    member.complain("\"" + std::string(name) + "\" is missing", std::string(what_to_write));
  }
  return member;
}

std::vector<std::pair<std::string, Place>> Members::all() {
  std::vector<std::pair<std::string, Place>> result;
  if (!object_) return result;
  for (const auto& [name, value] : place_.json().items()) {
    asked_.push_back(name);
    result.emplace_back(name, Place(&value, pointer_to(place_.pointer(), name), place_.problems()));
  }
  return result;
}

void Members::no_others() const {
  if (!object_) return;
  for (const auto& [name, value] : place_.json().items()) {
    if (std::ranges::find(asked_, name) != asked_.end()) continue;
    const Place member(&value, pointer_to(place_.pointer(), name), place_.problems());
    const std::span<const std::string> known(asked_);
    member.complain(
        "there is no member \"" + beginning(name, 64) + "\" here" + did_you_mean(name, known),
        listed(known));
  }
}

}  // namespace repose::server
