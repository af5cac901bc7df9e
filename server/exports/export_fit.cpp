#include "server/exports/export_fit.hpp"

#include <algorithm>

#include "server/exports/export.hpp"
#include "server/json/place.hpp"
#include "server/json/text.hpp"
#include "server/nightly/continuation.hpp"

namespace repose::server {

using engine::Unexpected;

Answer<std::string> export_fit(const db::Store& store, std::int64_t id, std::string_view format) {
  const auto known = std::ranges::find(export_format_names, format);
  if (known == export_format_names.end()) {
    return Unexpected{Refusal{Refusal::Kind::not_found,
                              "there is no export format \"" + std::string(format) + "\"" +
                                  did_you_mean(format, export_format_names) +
                                  "; there are: " + listed(export_format_names),
                              {}}};
  }
  const std::string name = "calibration " + std::to_string(id);
  const auto record = store.calibration(id);
  if (!record) return Unexpected{not_found("calibration", id)};
  auto found = published(store, id);
  if (!found || found->fit.best.empty()) {
    return Unexpected{Refusal{Refusal::Kind::wrong_state,
                              name + " is " + record->state + ": it has no fit to export",
                              {}}};
  }
  const auto used = store.used(id, 1, std::nullopt);
  return print_export(
      {.id = id,
       .finished_at = print_time(record->finished_at.value_or(0)),
       .engine_version = used.empty() ? "unknown" : used.front().evaluation.engine_version,
       .calibration = std::move(found->calibration),
       .fit = std::move(found->fit)},
      static_cast<ExportFormat>(known - export_format_names.begin()));
}

}  // namespace repose::server
