/// Report: a calibration as one HTML file that needs nothing else: no network, no script. For a
/// screen, a phone and paper.
#pragma once

#include <span>
#include <string>

#include "server/json/report_json.hpp"
#include "server/report/image.hpp"

namespace repose::server {

struct ReportPicture {
  std::string title;    ///< "kettle, filled"
  std::string caption;  ///< "2 316 grains, draft fidelity, seed 1"
  Image image;
};

/// What the document does not say of itself.
struct Provenance {
  std::string program;   ///< name and version
  std::string database;  ///< path
  std::string written_at;
};

/// Pure: equal arguments give equal text.
std::string print_report(const CalibrationDocument& document,
                         std::span<const ReportPicture> pictures,
                         const Provenance& provenance);

}  // namespace repose::server
