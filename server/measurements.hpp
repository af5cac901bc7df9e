/// Measurements that users keep, calibrations that refer to them, and the fits of a material.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "db/measurement_store.hpp"
#include "server/service.hpp"

namespace repose::server {

/// Keeps a new version of a set, sent as a document or as a table of that material; the answer is
/// its document.
Answer<std::string> put_measurement_set(db::Store& store,
                                        const std::string& name,
                                        std::string_view content,
                                        const std::optional<std::string>& table_of);

/// The newest version where none is given; as a table, or as a document.
Answer<std::string> measurement_set(db::Store& store,
                                    const std::string& name,
                                    const std::optional<std::int64_t>& version,
                                    bool as_table);

/// What a submission asks for: its study with measurements in their place, and where they are from.
struct ResolvedSubmission {
  std::string study;
  db::SourceRecord source;
  bool takes_grain = false;  ///< of the material of users that the source names
};
Answer<ResolvedSubmission> resolve_submission(db::Store& store, std::string_view text);

}  // namespace repose::server
