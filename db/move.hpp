/// move_to(): gives a file another name, which the disk has when it returns.
#pragma once

#include <filesystem>

namespace repose::db {

/// In place of what has that name. Throws db::Error.
void move_to(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace repose::db
