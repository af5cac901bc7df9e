/// CellGrid: sorts grains by the cell they are in and finds the pairs that are near one another.
///
/// Cells follow one another along the scene's shortest axis first and along its longest last, so
/// that neighbours in space are near in memory.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/grains.hpp"
#include "engine/team.hpp"

namespace repose::engine {

class CellGrid {
 public:
  /// Two grains of a pair: rows in any order.
  struct Pair {
    std::uint32_t a, b;
  };

  /// Brings coordinates into the periods (m; 0 where not periodic, z never is) and sorts the rows
  /// by cells of at least that edge, m.
  void sort(Grains& grains, const Vec3& period, double edge);

  /// Finds every pair nearer than the radii and skins (m) of both, once: a list for each part of
  /// the rows, in which a's row is in that part and grows. The grains are those last sorted; the
  /// pairs are valid until the next call.
  std::span<const std::vector<Pair>> near_pairs(const Grains& grains,
                                                std::span<const double> skins,
                                                std::span<const std::uint32_t> part_bounds,
                                                const Team& team);

  /// A grain that has moved since the sort: where it is now, and its new skin, m.
  void move(const Grains& grains, std::uint32_t row, double skin);

  /// Finds every pair of one row nearer than the radii and skins of both; the row is a. Others are
  /// looked for where they were when they were sorted or last moved; of those that were moved, each
  /// is looked at.
  std::span<const Pair> near_pairs_of(std::uint32_t row);

 private:
  struct Axis {
    double low = 0.0, width = 1.0;  ///< of the first cell, m
    double period = 0.0;
    int cells = 1;
  };

  /// Cells of one axis that a search visits: one run of them, or two round a periodic side.
  struct Runs {
    std::array<int, 2> first, last;
    int count;
  };

  /// What is searched, in the order of the axes in memory, with room for a quad past the end.
  struct Spots {
    std::array<std::vector<double>, 3> at;  ///< coordinates along order_, m
    std::vector<double> near;               ///< radius and skin, m
    std::vector<double> skin;
  };

  struct Search;

  void lay_out(const Grains& grains, const Vec3& period, double edge);
  void fill_spots(const Grains& grains, std::span<const double> skins);
  [[nodiscard]] Runs runs(const Axis& axis, double low, double high) const;
  [[nodiscard]] Search search() const;
  template <class See>
  void for_lines(const Search& search, double reach, const See& see) const;
  void find_for(Search& search, std::vector<Pair>& found) const;
  static void find_part(const CellGrid& grid,
                        std::uint32_t first,
                        std::uint32_t last,
                        std::vector<Pair>& found);

  std::array<Axis, 3> axes_;                   ///< x, y, z
  std::array<std::size_t, 3> order_{0, 1, 2};  ///< axes, the one whose cells are adjacent first
  std::vector<std::uint32_t> start_;           ///< first row of each cell
  std::vector<std::uint32_t> cell_of_;
  Spots spots_;
  double largest_radius_ = 0.0;
  double smallest_skin_ = 0.0;
  double largest_skin_ = 0.0;
  std::vector<std::uint32_t> moved_;      ///< rows whose cell may be another than that sorted
  std::vector<std::vector<Pair>> found_;  ///< by part
  std::vector<Pair> pairs_;
};

}  // namespace repose::engine
