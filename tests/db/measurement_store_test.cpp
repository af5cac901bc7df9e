#include "db/measurement_store.hpp"

#include <catch2/catch.hpp>

#include "tests/support/temporary_folder.hpp"

using namespace repose::db;
using repose::tests::TemporaryFolder;

TEST_CASE("the best fit of a name and a material is its smallest misfit", "[db]") {
  const TemporaryFolder folder;
  Store store(folder / "a.db", Access::write);
  MeasurementStore measurements(store);
  const auto finish = [&](const std::string& name,
                          const std::optional<std::string>& material,
                          const std::string& state,
                          double misfit) {
    const auto id = measurements.add_calibration(name, "{}", "d", {material, std::nullopt}, 1);
    store.finish(id, state, "{}", misfit, std::nullopt, 2);
  };
  finish("a", "glass", "done", 3.0);
  finish("a", "glass", "done", 1.0);
  finish("a", "glass", "failed", 0.1);
  finish("a", "steel", "done", 5.0);
  finish("a", std::nullopt, "done", 7.0);
  finish("a", std::nullopt, "done", 4.0);
  finish("b", "glass", "done", 2.0);
  std::vector<std::pair<std::string, double>> all;
  for (const FitRecord& fit : measurements.best_fits({})) {
    all.emplace_back(fit.calibration.name + " " + fit.material.value_or("-"),
                     fit.calibration.misfit.value_or(0.0));
  }
  CHECK(all == std::vector<std::pair<std::string, double>>{
                   {"a -", 4.0}, {"a glass", 1.0}, {"a steel", 5.0}, {"b glass", 2.0}});
  CHECK(measurements.best_fits({.name = "b"}).size() == 1);
  CHECK(measurements.best_fits({.material = "glass"}).size() == 2);
  CHECK(measurements.best_fits({.name = "c"}).empty());
}
