/// LineageReport: models of which each adds an effect to the one before, as one HTML file that
/// needs nothing else: no network, no script. For a screen, a phone and paper.
#pragma once

#include <string>

#include "server/report/lineage.hpp"
#include "server/report/report.hpp"

namespace repose::server {

/// Pure: equal arguments give equal text. The lineage has at least one generation.
std::string print_lineage_report(const Lineage& lineage, const Provenance& provenance);

}  // namespace repose::server
