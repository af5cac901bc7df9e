#include "server/lineage.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "calibrator/comparison.hpp"
#include "server/json/calibration_json.hpp"
#include "server/json/fit_json.hpp"
#include "server/json/lineage_json.hpp"

namespace repose::server {

namespace {

/// The first ancestor; one whose parent is gone is its own.
db::CalibrationRecord root_of(const db::Store& store, db::CalibrationRecord record) {
  std::set<std::int64_t> seen;
  while (seen.insert(record.id).second) {
    const auto parent = parent_of(record.request);
    auto found = parent ? store.calibration(*parent) : std::nullopt;
    if (!found) break;
    record = *std::move(found);
  }
  return record;
}

std::optional<calibrator::Comparison> comparison_of(const db::CalibrationRecord& record) {
  const auto calibration = parse_calibration(record.request);
  if (!calibration || !record.fit || record.state != "done") return std::nullopt;
  const auto fit = parse_fit(*calibration, *record.fit);
  if (!fit) return std::nullopt;
  return calibrator::compare(*calibration, *fit);
}

std::optional<db::DiagnosisRecord> last_finished(const std::vector<db::DiagnosisRecord>& records) {
  const auto found = std::ranges::find(records, "done", &db::DiagnosisRecord::state);
  return found == records.end() ? std::nullopt : std::optional(*found);
}

}  // namespace

Answer<std::string> lineage(const db::Store& store, std::int64_t id) {
  auto record = store.calibration(id);
  if (!record) return engine::Unexpected{not_found("calibration", id)};
  std::vector<db::CalibrationRecord> waiting{root_of(store, *std::move(record))};
  std::vector<Descent> found;
  std::set<std::int64_t> seen;
  while (!waiting.empty()) {
    const db::CalibrationRecord next = std::move(waiting.back());
    waiting.pop_back();
    if (!seen.insert(next.id).second) continue;
    found.push_back({next, comparison_of(next), last_finished(store.diagnoses(next.id))});
    auto children = store.children(next.id);
    waiting.insert(waiting.end(), children.rbegin(), children.rend());
  }
  return print_lineage(id, found);
}

}  // namespace repose::server
