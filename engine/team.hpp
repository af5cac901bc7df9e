/// Team: threads that are lent to a run. The engine starts none itself.
///
/// A large run is cut into parts whose number depends on its grains alone, and what parts give each
/// other is added up in their order. So the bits are equal for any team.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace repose::engine {

/// Calls work(0) to work(parts - 1), each once, in any order and on any threads, and returns when
/// all are done. Empty: one after another on the calling thread.
using Team = std::function<void(std::size_t parts, const std::function<void(std::size_t)>& work)>;

inline void share(const Team& team,
                  std::size_t parts,
                  const std::function<void(std::size_t)>& work) {
  if (team && parts > 1) return team(parts, work);
  for (std::size_t part = 0; part < parts; ++part) work(part);
}

/// Where the parts of that many rows begin, and the end of the last. Parts of fewer rows would
/// spend more on their borders than two threads gain.
inline std::vector<std::uint32_t> part_bounds(std::size_t rows) {
  constexpr std::size_t least_rows = 4096;
  constexpr std::size_t most_parts = 8;
  std::size_t parts = rows / least_rows;
  parts = parts < 1 ? 1 : parts > most_parts ? most_parts : parts;
  std::vector<std::uint32_t> bounds;
  bounds.reserve(parts + 1);
  for (std::size_t part = 0; part <= parts; ++part) {
    bounds.push_back(static_cast<std::uint32_t>(rows * part / parts));
  }
  return bounds;
}

}  // namespace repose::engine
