#include "engine/stl.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace repose::engine {

namespace {

using Facets = Result<std::vector<Triangle>, MeshError>;

constexpr std::size_t header_bytes = 80;
constexpr std::size_t facets_begin = header_bytes + 4;
constexpr std::size_t facet_bytes = 50;
constexpr std::size_t corners_begin = 12;  // in a facet, after its normal

Unexpected<MeshError> fault(MeshFault kind, std::size_t facet, const std::string& what) {
  const std::string place = facet > 0 ? "facet " + std::to_string(facet) + ": " : std::string();
  return {MeshError{kind, facet, place + what}};
}

Unexpected<MeshError> not_finite(std::size_t facet, int corner) {
  return fault(
      MeshFault::not_finite,
      facet,
      "corner " + std::to_string(corner + 1) + " has a coordinate that is no number or infinite");
}

bool finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::uint32_t whole_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
  }
  return value;
}

double number_at(std::string_view bytes, std::size_t at) {
  return std::bit_cast<float>(whole_at(bytes, at));
}

std::size_t length_of_binary(std::size_t facets) { return facets_begin + facet_bytes * facets; }

Facets read_binary(std::string_view bytes) {
  if (bytes.size() < facets_begin) {
    return fault(MeshFault::truncated, 0, "the file ends within its header");
  }
  const std::size_t count = whole_at(bytes, header_bytes);
  const std::size_t held = (bytes.size() - facets_begin) / facet_bytes;
  if (bytes.size() != length_of_binary(count)) {
    const std::string said = "the header says " + std::to_string(count) + " facets, ";
    if (held < count && bytes.size() != length_of_binary(held)) {
      return fault(MeshFault::truncated, held + 1, said + "the file ends within this one");
    }
    return fault(MeshFault::wrong_count, 0, said + "the file has room for " + std::to_string(held));
  }
  std::vector<Triangle> facets(count);
  for (std::size_t k = 0; k < count; ++k) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::size_t at =
          length_of_binary(k) + corners_begin + 12 * static_cast<std::size_t>(corner);
      Vec3& point = facets[k][static_cast<std::size_t>(corner)];
      point = {number_at(bytes, at), number_at(bytes, at + 4), number_at(bytes, at + 8)};
      if (!finite(point)) return not_finite(k + 1, corner);
    }
  }
  return facets;
}

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// Text as words.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  /// The next word; empty at the end.
  std::string_view next() {
    const auto first = std::ranges::find_if_not(rest_, is_space);
    const auto last = std::find_if(first, rest_.end(), is_space);
    const auto begin = static_cast<std::size_t>(first - rest_.begin());
    const auto length = static_cast<std::size_t>(last - first);
    const std::string_view word = rest_.substr(begin, length);
    rest_.remove_prefix(begin + length);
    return word;
  }
  void skip_line() { rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size())); }

 private:
  std::string_view rest_;
};

/// Whether a word is that keyword, whatever its case.
bool is_word(std::string_view word, std::string_view keyword) {
  return std::ranges::equal(word, keyword, [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  });
}

/// Not a number where the word is none; infinite where it is too large for one.
double number_in(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = end == word.data() + word.size();
  if (error == std::errc::result_out_of_range && whole) {
    return word.find("e-") != word.npos || word.find("E-") != word.npos
               ? 0.0
               : std::numeric_limits<double>::infinity();
  }
  return error == std::errc{} && whole ? value : std::numeric_limits<double>::quiet_NaN();
}

/// The corners of a facet, after the word "facet".
Result<Triangle, MeshError> read_facet(Words& words, std::size_t facet) {
  const auto expect = [&](std::string_view keyword) -> std::optional<MeshError> {
    const std::string_view word = words.next();
    if (is_word(word, keyword)) return std::nullopt;
    if (word.empty()) {
      return fault(MeshFault::truncated, facet, "the file ends within this one").error;
    }
    return fault(MeshFault::not_stl,
                 facet,
                 "\"" + std::string(word.substr(0, 20)) + "\" stands where \"" +
                     std::string(keyword) + "\" belongs")
        .error;
  };
  if (auto error = expect("normal")) return Unexpected{*error};
  for (int k = 0; k < 3; ++k) words.next();
  for (const std::string_view keyword : {"outer", "loop"}) {
    if (auto error = expect(keyword)) return Unexpected{*error};
  }
  Triangle triangle;
  for (int corner = 0; corner < 3; ++corner) {
    if (auto error = expect("vertex")) return Unexpected{*error};
    Vec3& point = triangle[static_cast<std::size_t>(corner)];
    for (double* const coordinate : {&point.x, &point.y, &point.z}) {
      const std::string_view word = words.next();
      if (word.empty()) {
        return fault(MeshFault::truncated, facet, "the file ends within this one");
      }
      *coordinate = number_in(word);
    }
    if (!finite(point)) return not_finite(facet, corner);
  }
  for (const std::string_view keyword : {"endloop", "endfacet"}) {
    if (auto error = expect(keyword)) return Unexpected{*error};
  }
  return triangle;
}

/// One solid or several.
Facets read_text(std::string_view bytes) {
  Words words(bytes);
  std::vector<Triangle> facets;
  bool inside = false;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (!inside && is_word(word, "solid")) {
      words.skip_line();
      inside = true;
    } else if (inside && is_word(word, "endsolid")) {
      words.skip_line();
      inside = false;
    } else if (inside && is_word(word, "facet")) {
      auto facet = read_facet(words, facets.size() + 1);
      if (!facet) return Unexpected{facet.error()};
      facets.push_back(*facet);
    } else {
      return fault(MeshFault::not_stl,
                   0,
                   "after " + std::to_string(facets.size()) + " facets comes \"" +
                       std::string(word.substr(0, 20)) + "\"");
    }
  }
  if (inside) {
    return fault(
        MeshFault::truncated,
        0,
        "the file ends after " + std::to_string(facets.size()) + " facets without \"endsolid\"");
  }
  return facets;
}

/// Binary files may begin with "solid", too: text has no other control characters than spaces.
bool is_text(std::string_view bytes) {
  constexpr std::size_t enough = 512;
  if (!is_word(Words(bytes).next(), "solid")) return false;
  return std::ranges::none_of(bytes.substr(0, enough), [](char c) {
    return static_cast<unsigned char>(c) < ' ' && !is_space(c);
  });
}

}  // namespace

Result<std::vector<Triangle>, MeshError> read_stl(std::string_view bytes) {
  const bool exact = bytes.size() >= facets_begin &&
                     bytes.size() == length_of_binary(whole_at(bytes, header_bytes));
  Facets facets = !exact && is_text(bytes) ? read_text(bytes) : read_binary(bytes);
  if (facets && facets->empty()) return fault(MeshFault::not_stl, 0, "the file holds no facet");
  return facets;
}

}  // namespace repose::engine
