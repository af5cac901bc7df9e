/// JSON text <-> values, with limits enforced while reading: hostile text is refused before it can
/// fill the memory or the stack.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "server/json/page.hpp"
#include "server/json/problem_list.hpp"

namespace repose::server {

/// Members stay in the order in which they were written.
using Json = nlohmann::ordered_json;

/// What a text may hold. nlohmann's values recurse when they are copied, printed or freed, so the
/// depth is what keeps the stack whole.
struct TextLimits {
  std::size_t bytes = 1U << 20U;
  std::size_t depth = 32;
  std::size_t string_bytes = 64U << 10U;
  std::size_t values = 100'000;
};

/// Limits for what this program has written itself: as large as it is.
inline TextLimits own_text(std::string_view text) {
  return {.bytes = text.size(), .string_bytes = text.size(), .values = text.size()};
}

/// The value of a text; nothing where it is no JSON or passes a limit. A member that is there twice
/// is a problem too, but the first of them is kept, so that the rest can be checked.
std::optional<Json> parse_text(std::string_view text,
                               const TextLimits& limits,
                               ProblemList& problems);

/// Compact where indent is negative. Bytes that are no UTF-8 are replaced.
std::string to_text(const Json& json, int indent = -1);

/// A page of a list. `last` is the cursor of its last item, with which the page after it is asked
/// for: there is one where as many items were found as were asked for.
Page print_page(Json items, int limit, const Json& last);

/// A number, null where it is not finite: JSON has no NaN.
Json number_or_null(double value);

// The way back: what a document of this program has in such a place.
double number_or_nan(const Json& json);
std::string text_or_empty(const Json& json);

/// "2026-11-23T14:05:09.120000Z" from microseconds since 1970.
std::string print_time(std::int64_t microseconds);

// What a row of the store may lack is null in its document.
Json time_or_null(const std::optional<std::int64_t>& microseconds);
/// A document that this program has written, as a value.
Json document_or_null(const std::optional<std::string>& text);

/// The pointer (RFC 6901) to a member, to an element.
std::string pointer_to(std::string_view parent, std::string_view member);
std::string pointer_to(std::string_view parent, std::size_t index);

/// The whole number that is a member of a document; nothing where there is none.
std::optional<std::int64_t> whole_member(std::string_view document, std::string_view member);

}  // namespace repose::server
