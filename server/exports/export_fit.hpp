/// export_fit(): the use case behind `repose export`.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "db/store.hpp"
#include "server/service.hpp"

namespace repose::server {

/// The fit of a finished calibration in a format of export_format_names.
Answer<std::string> export_fit(const db::Store& store, std::int64_t id, std::string_view format);

}  // namespace repose::server
