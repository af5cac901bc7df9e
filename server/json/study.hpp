/// Study: a study document while it is read: the calibration so far, and where each part of it
/// stands, for the checks that need several parts at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "calibrator/calibration.hpp"
#include "server/json/place.hpp"

namespace repose::server {

/// The part of the document that gives a parameter its value.
enum class Part : std::uint8_t { materials, fixed, free, tied };

struct Study {
  struct Claim {
    Part part;
    std::string pointer;
  };
  struct PlacedTie {
    calibrator::Tie tie;
    Place place;
  };

  calibrator::Calibration calibration;
  /// Every parameter the document names, also where its value has a problem: so one mistake is not
  /// reported as a second one.
  std::map<engine::ParameterKey, Claim> claims;
  std::vector<PlacedTie> ties;
  std::size_t free_named = 0;    ///< entries of `free`, whatever they are worth
  std::size_t fitted_named = 0;  ///< measurements that are not held out, likewise
  int curves = 0;
  std::vector<std::string> measured_at;  ///< where each measurement stands
};

void read_materials(const Place& place, Study& study);
/// The spheres that a grain is made of: materials.grain.shape.
void read_shape(const Place& place, Study& study);
void read_fixed(const Place& place, Study& study);
void read_free(const Place& place, Study& study);
void read_tied(const Place& place, Study& study);
void read_constraints(const Place& place, Study& study);
void read_measurements(const Place& place, Study& study);
void read_measurement(const Place& place, Study& study);

/// A measurement of several values along one setting of its experiment.
bool is_curve(const Place& place);
void read_curve(const Place& place, Study& study);

/// What only the whole document tells: ties that lead nowhere, materials that lack a property,
/// constraints that nothing keeps, measurements that contradict each other or that a free parameter
/// does not reach, apparatus that cannot work, nothing to fit, too little to spend.
void check_study(const Place& document, const Study& study);

}  // namespace repose::server
