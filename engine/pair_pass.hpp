/// PairPass: a step's forces between grains. Finds the candidates that touch, a block at a time,
/// applies the law to the block while its grains are still in the cache, and adds the loads in the
/// order of the candidates. A pass covers a part of a scene; what grains of other parts receive is
/// kept aside.
#pragma once

#include "engine/contact_list.hpp"
#include "engine/contact_model.hpp"
#include "engine/grains.hpp"

namespace repose::engine {

/// Loads for grains of other parts, in the order in which they came.
struct Spill {
  std::vector<std::uint32_t> rows;
  std::vector<GrainLoad> loads;
};

struct PairPass {
  const PairLaw& law;
  Period period;
  double dt;  ///< s
  const GrainRow* rows;
  GrainLoad* loads;
  Candidates& candidates;
  Part part;  ///< to work on
  int history_columns;
  ContactBlock& block;     ///< room to work in
  Spill& spill;            ///< is added to
  std::size_t closed = 0;  ///< contacts found
};

void push_pairs(PairPass& pass);

/// Hands out what other parts' grains received, and forgets it.
void deliver(Spill& spill, GrainLoad* loads);

}  // namespace repose::engine
