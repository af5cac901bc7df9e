/// Place: a value in a request together with the way to it, so that a problem names where it is.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/json/text.hpp"

namespace repose::server {

class Place {
 public:
  /// `value` is null where nothing stands at that place.
  Place(const Json* value, std::string pointer, ProblemList& problems)
      : value_(value), pointer_(std::move(pointer)), problems_(&problems) {}

  [[nodiscard]] bool exists() const { return value_ != nullptr; }
  [[nodiscard]] const Json& json() const { return *value_; }  ///< of a place that exists
  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] ProblemList& problems() const { return *problems_; }

  /// What stands there, in a few words.
  [[nodiscard]] std::string found() const;

  void complain(std::string message, std::string allowed) const;
  void complain(std::string message, std::string found_instead, std::string allowed) const;

  // Each reads what stands there, or complains and gives nothing.
  [[nodiscard]] std::optional<double> number() const;
  [[nodiscard]] std::optional<std::int64_t> whole(std::int64_t least, std::int64_t most) const;
  [[nodiscard]] std::optional<std::uint64_t> seed() const;
  [[nodiscard]] std::optional<bool> truth() const;
  [[nodiscard]] std::optional<std::string> text(std::size_t longest) const;
  /// The index of the name that stands there.
  [[nodiscard]] std::optional<std::size_t> one_of(std::span<const std::string_view> names,
                                                  std::string_view kind) const;
  /// The elements of an array; none where nothing is there.
  [[nodiscard]] std::vector<Place> elements() const;

 private:
  const Json* value_;
  std::string pointer_;
  ProblemList* problems_;
};

/// The members of an object. A member that nobody asked for is a problem, so what is allowed is
/// written once: where it is read.
class Members {
 public:
  /// Complains where something other than an object stands.
  explicit Members(const Place& place);

  /// A member that may be missing.
  Place optional(std::string_view name);
  /// A member that must be there.
  Place required(std::string_view name, std::string_view what_to_write);
  /// Every member, for objects whose members are names of things.
  [[nodiscard]] std::vector<std::pair<std::string, Place>> all();
  /// Complains of the members that nobody asked for.
  void no_others() const;

  [[nodiscard]] bool is_object() const { return object_; }

 private:
  Place place_;
  bool object_;
  std::vector<std::string> asked_;
};

/// "a, b, c"
std::string listed(std::span<const std::string_view> names);
std::string listed(std::span<const std::string> names);

/// " (did you mean \"height\"?)", or nothing where no name is near.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> names);
std::string did_you_mean(std::string_view word, std::span<const std::string> names);

}  // namespace repose::server
