/// PairPass: a step's forces between grains. Finds the candidates that touch, a block at a time,
/// applies the law to the block while its grains are still in the cache, and adds the loads in the
/// order of the candidates.
#pragma once

#include "engine/contact_list.hpp"
#include "engine/contact_model.hpp"
#include "engine/grains.hpp"

namespace repose::engine {

struct PairPass {
  const PairLaw& law;
  Period period;
  double dt;     ///< s
  double reach;  ///< gap up to which a contact that has closed stays closed, m
  const GrainRow* rows;
  GrainLoad* loads;
  Candidates& candidates;
  std::size_t first, last;  ///< of them: to work on, from the first to before the last
  int history_columns;
  ContactBlock& block;     ///< room to work in
  std::size_t closed = 0;  ///< contacts found
};

void push_pairs(PairPass& pass);

}  // namespace repose::engine
