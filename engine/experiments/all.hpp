/// Every virtual experiment there is. To add one: its file, its line here.
#pragma once

#include <array>
#include <span>

#include "engine/experiment.hpp"

namespace repose::engine {

namespace experiments {
extern const ExperimentInfo compression;
extern const ExperimentInfo draw_down;
extern const ExperimentInfo drop;
extern const ExperimentInfo drum;
extern const ExperimentInfo heap;
extern const ExperimentInfo kettle;
extern const ExperimentInfo tilting_box;
}  // namespace experiments

inline std::span<const ExperimentInfo> all_experiments() {
  static const std::array list{experiments::drop,
                               experiments::kettle,
                               experiments::tilting_box,
                               experiments::heap,
                               experiments::draw_down,
                               experiments::drum,
                               experiments::compression};
  return list;
}

}  // namespace repose::engine
