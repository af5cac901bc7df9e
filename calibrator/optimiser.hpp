/// Minima of cheap functions in a box: what the emulator is searched with. Never the simulations.
///
/// Global: DIRECT-L (Gablonsky & Kelley 2001, J. Global Optim. 21, 27-37). Local: BOBYQA (Powell
/// 2009, DAMTP report NA06), in one dimension subplex (Rowan 1990); where relations restrict the
/// box, COBYLA (Powell 1994). All by NLopt, which is seeded before each search on the calling
/// thread, where its random state lives. The point returned is always in the box and keeps its
/// relations, and its value is the smallest seen; infinity where no point kept them. An exception
/// of the function ends the search and is thrown on from here: none passes through NLopt's own
/// frames.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace repose::calibrator {

/// NaN counts as a very large value.
using Objective = std::function<double(std::span<const double>)>;

struct Box {
  std::vector<double> lower;
  std::vector<double> upper;
  std::vector<Objective> excesses = {};  ///< relations that hold where none of them is above 0
};

Box unit_box(std::size_t dimensions);

struct Minimum {
  std::vector<double> at;
  double value = 0.0;
};

struct LocalSearch {
  int evaluations = 80;     ///< about
  double step = 0.1;        ///< first step, in units of the box's coordinates
  double tolerance = 1e-4;  ///< on the coordinates, absolute
};

/// The minimum near `start`.
Minimum minimise_locally(const Objective& objective,
                         const Box& box,
                         std::vector<double> start,
                         const LocalSearch& options = {});

/// A rough global minimum.
Minimum minimise_globally(const Objective& objective, const Box& box, int evaluations);

/// Global search, then local ones from what it found and from each of the starts.
Minimum minimise(const Objective& objective,
                 const Box& box,
                 std::span<const std::vector<double>> starts,
                 int global_evaluations,
                 const LocalSearch& options = {});

/// What a calibration can be searched with directly, one evaluation per call, for comparison.
///
///   cobyla  Powell 1994 (Advances in Optimization and Numerical Analysis, 51-67)
///   crs2    Kaelo & Ali 2006 (J. Optim. Theory Appl. 130, 253-264)
///   isres   Runarsson & Yao 2005 (IEEE Trans. Syst. Man Cybern. C 35, 233-243)
///   mlsl    Kucherenko & Sytsko 2005 (Comput. Optim. Appl. 30, 297-318), BOBYQA from each start
enum class Algorithm : std::uint8_t { bobyqa, cobyla, sbplx, crs2, isres, direct_l, mlsl };

struct DirectSearch {
  int evaluations = 100;       ///< about; `done` is exact
  double step = 0.25;          ///< first step of the local ones
  double tolerance = 1e-3;     ///< on the coordinates, absolute
  std::uint64_t seed = 1;      ///< of those that draw
  std::function<bool()> done;  ///< asked after each evaluation; may be empty
};

/// In one dimension subplex stands in for BOBYQA, which needs two.
Minimum minimise_by(Algorithm algorithm,
                    const Objective& objective,
                    const Box& box,
                    std::vector<double> start,
                    const DirectSearch& options);

}  // namespace repose::calibrator
