/// ContactList: who may touch whom, and the history of those who do.
///
/// Candidates are pairs nearer than their skins; they stay valid until a grain has moved by its own
/// skin, or a wall by its. A grain's skin grows with its speed, so that a falling stream does not
/// force the settled bed to be searched again and again. History lives beside its candidate and is
/// carried across rebuilds by the permanent ids; of two grains, the one with the smaller id is end
/// i, whatever their rows.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/boundary.hpp"
#include "engine/cell_grid.hpp"
#include "engine/contact_block.hpp"
#include "engine/grains.hpp"
#include "engine/team.hpp"

namespace repose::engine {

/// Candidates of one kind, and what is remembered of each.
struct Candidates {
  std::vector<std::uint32_t> i;      ///< row of end i
  std::vector<std::uint32_t> j;      ///< row of end j, or surface
  std::vector<std::uint8_t> closed;  ///< whether the contact was closed in the last step
  std::vector<double> history;       ///< history_columns per candidate, and one number more

  [[nodiscard]] std::size_t size() const { return i.size(); }
  /// Forgets the contact of a candidate that has opened.
  void open(std::uint32_t candidate, int history_columns) {
    closed[candidate] = 0;
    std::fill_n(history.begin() + static_cast<std::ptrdiff_t>(candidate) * history_columns,
                history_columns,
                0.0);
  }
};

/// What one of a team works on: rows, and the pairs among them.
struct Part {
  std::uint32_t first_row, last_row;  ///< from the first to before the last
  std::size_t first, last;            ///< candidate pairs, likewise
};

class ContactList {
 public:
  explicit ContactList(int history_columns) : history_columns_(history_columns) {}

  /// Sorts the grains by cell and finds all candidates anew. `period` is 0 where not periodic;
  /// `horizon` is the time (s) a grain may fly before its skin is used up. `body_of_id` names the
  /// clump of each id, if any: members of one clump are no candidates. Contacts that are closed
  /// stay candidates as far as their surfaces are not `reach` (m) apart.
  void rebuild(Grains& grains,
               std::span<const Surface> surfaces,
               const Vec3& period,
               double horizon,
               std::span<const std::uint32_t> body_of_id = {},
               const Team& team = {},
               double reach = 0.0);

  /// The parts as last rebuilt. After the pairs of the last part come those across two parts and
  /// those that came by repairs.
  [[nodiscard]] std::span<const Part> parts() const { return parts_; }

  /// Looks again at the few grains that have moved by their skins, so that the list is valid once
  /// more. False, and nothing changed, when they are too many: then rebuild.
  bool repair(const Grains& grains,
              std::span<const Surface> surfaces,
              double horizon,
              std::span<const std::uint32_t> body_of_id = {});

  /// How far each wall may move before the list is no longer valid, m.
  [[nodiscard]] std::span<const double> wall_skins() const { return wall_skins_; }

  /// Where a grain was when it was last looked at.
  struct Anchor {
    double x, y, z;       ///< m
    double skin_squared;  ///< m2
  };
  [[nodiscard]] std::span<const Anchor> anchors() const { return anchors_; }
  /// Whether one of these rows has moved by its skin since then.
  [[nodiscard]] bool outlived(const Grains& grains, std::span<const std::uint32_t> rows) const;

  /// Follows rows that were taken out: new_row[k] is where row k went, or `gone`.
  void renumber(const std::vector<std::uint32_t>& new_row, std::uint32_t gone);

  [[nodiscard]] int history_columns() const { return history_columns_; }

  Candidates pairs;
  Candidates walls;

 private:
  /// Histories of the closed contacts by id of end i, while the rows are re-ordered.
  struct Memory {
    std::vector<std::uint32_t> start;  ///< first entry of each id
    std::vector<std::uint32_t> j;      ///< id of end j, or surface
    std::vector<double> history;
  };

  [[nodiscard]] Memory remember(const Candidates& candidates,
                                const Grains& grains,
                                Partner partner) const;
  void recall(const Memory& memory,
              Candidates& candidates,
              const Grains& grains,
              Partner partner) const;
  void find_pairs(const Grains& grains,
                  std::span<const std::uint32_t> body_of_id,
                  const Team& team);
  /// Where a grain is now; its skin starts anew.
  void anchor(const GrainRow& grain, std::size_t row, double horizon);
  void append(Candidates& candidates, const std::vector<std::uint64_t>& found);
  void find_walls(const Grains& grains, std::span<const Surface> surfaces);

  int history_columns_;
  CellGrid grid_;
  std::vector<Part> parts_;
  double slowest_skin_ = 0.0;
  std::vector<double> skins_;
  std::vector<double> wall_skins_;
  std::size_t repaired_ = 0;  ///< grains looked at again since the last rebuild
  std::vector<Anchor> anchors_;
};

}  // namespace repose::engine
