// What replicates of one virtual experiment say together.
#include "server/json/replicates_json.hpp"

#include <catch2/catch.hpp>

using namespace repose;
using namespace repose::server;

namespace {

Replicates with_overlaps_at_rest(const std::vector<double>& overlaps) {
  Replicates replicates;
  replicates.trial.experiment.name = "kettle";
  for (const double overlap : overlaps) {
    engine::Evaluation evaluation{replicates.trial, std::vector<engine::Observation>{}, {}};
    evaluation.effort.overlap_at_rest = overlap;
    replicates.evaluations.push_back(evaluation);
    replicates.wall_seconds.push_back(1.0);
  }
  return replicates;
}

}  // namespace

TEST_CASE("grains that rest more than 1 % of their radius in one another are warned of",
          "[server]") {
  CHECK(warnings(with_overlaps_at_rest({0.002, 0.01})).empty());

  const Replicates soft = with_overlaps_at_rest({0.002, 0.0347, 0.02});
  const std::vector<std::string> said = warnings(soft);
  REQUIRE(said.size() == 1);
  CHECK(said.front().starts_with("at rest grains overlap by up to 3.5 % of their radius"));
  CHECK(print_replicates(soft, "1").find(said.front()) != std::string::npos);
}
