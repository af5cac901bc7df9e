/// Export: a fit for other programs: its numbers as JSON or CSV, or ready input of another DEM
/// code.
///
/// An input file says the same physics in that code's own conventions, runs as it is, and names at
/// its top what of the fit the code cannot say. Two marked places are the user's: the domain, and
/// the scene that stands at its end as an example.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "calibrator/calibration.hpp"
#include "calibrator/fit.hpp"
#include "server/exports/dem_model.hpp"

namespace repose::server {

enum class ExportFormat : std::uint8_t { json, csv, liggghts, lammps, yade };

inline constexpr std::array<std::string_view, 5> export_format_names{
    "json", "csv", "liggghts", "lammps", "yade"};

/// A finished calibration.
struct ExportedFit {
  std::int64_t id = 0;
  std::string finished_at;
  std::string engine_version;  ///< that answered its evaluations
  calibrator::Calibration calibration;
  calibrator::Fit fit;
};

std::string print_export(const ExportedFit& fit, ExportFormat format);

// The input files. `title` says what the fit is, one line a comment.
std::string print_liggghts(const DemModel& model, const std::vector<std::string>& title);
std::string print_lammps(const DemModel& model, const std::vector<std::string>& title);
std::string print_yade(const DemModel& model, const std::vector<std::string>& title);

/// Lines that begin with "# ": the title, and what is unsaid.
std::string comment_head(const std::vector<std::string>& title,
                         const std::vector<std::string>& unsaid,
                         std::string_view code);

/// A number that reads back exactly.
std::string exact(double value);

/// Replaces each name by its text, wherever it stands.
std::string filled(std::string text,
                   const std::vector<std::pair<std::string_view, std::string>>& values);

}  // namespace repose::server
