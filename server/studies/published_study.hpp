/// PublishedStudy: a simulation study as its paper printed it: what was run with which inputs, and
/// what came out. Data (server/studies/NAME.json), read once.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace repose::server {

/// A printed mean and its standard deviation, in the unit of the paper.
struct PublishedNumber {
  double mean = 0.0;
  double deviation = 0.0;
};

/// A virtual experiment of the study and what the paper aimed at with it.
struct StudyExperiment {
  std::string experiment;  ///< its name in the catalogue
  std::string observable;
  std::string unit;     ///< of all the paper's numbers for it
  double target = 0.0;  ///< in that unit
  int replicates = 0;   ///< the paper's
  int quick_replicates = 0;
};

/// An input of the model and the values it was given. The code of a run has a digit for each
/// factor, in order, that chooses the level, counted from 1.
struct StudyFactor {
  std::string factor;
  std::string unit;
  std::vector<std::string> parameters;      ///< as in assignments: FIELD:BETWEEN
  std::vector<std::vector<double>> levels;  ///< of each level, a value for each parameter
};

/// A combination of inputs. "1s_16233": spheres of a grain, then the other factors' digits.
struct StudyRun {
  std::string run;
  std::map<std::string, PublishedNumber> printed;  ///< by experiment; none where it was not run
};

struct StudyGroup {
  std::string group;
  std::vector<std::string> runs;
};

struct StudyTable {
  std::string table;  ///< "Table 8"
  std::string title;
  std::vector<StudyGroup> groups;
};

/// What the paper found between the restitution given and the one read from the drop test.
struct DropAccuracy {
  double restitution = 0.0;
  double percent_low = 0.0, percent_high = 0.0;  ///< deviation, its smallest and largest, %
};

/// Another reading of what the paper leaves open, tried on the base.
struct StudyVariant {
  std::string variant;
  std::string kind;  ///< of the question it asks: "rolling law", "rim"
  std::string meaning;
  std::vector<std::string> experiments;
  std::vector<std::string> set;       ///< assignments FIELD:BETWEEN=VALUE
  std::vector<std::string> settings;  ///< assignments NAME=VALUE
};

struct PublishedStudy {
  std::string name;
  std::string title;
  std::string citation;
  std::vector<std::string> reading;  ///< how the paper was read where it leaves room, in sentences
  std::string base;                  ///< the run that every other is compared with
  std::string best;                  ///< the run that the authors chose
  std::vector<StudyExperiment> experiments;
  std::string drop_experiment, drop_observable;
  std::vector<DropAccuracy> drop_accuracy;
  std::vector<std::string> common;  ///< assignments that hold in every run
  std::vector<StudyFactor> factors;
  std::vector<StudyRun> runs;
  std::vector<StudyTable> tables;
  /// Hours of computing for a simulated second: by run, then by experiment.
  std::vector<StudyRun> computing_hours;
  std::vector<StudyVariant> variants;
  std::string search;  ///< the search for the best set, as a calibration's document
  int quick_search_evaluations = 0;

  [[nodiscard]] const StudyRun& run(std::string_view name) const;  ///< throws std::out_of_range
};

}  // namespace repose::server
