/// Backups: a copy of the whole database in one file, taken while another process writes, and put
/// back in its place.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace repose::db {

/// Writes the copy beside `file` first, checks it, and gives it that name only then. Throws
/// db::Error; a file that is there already is one.
void back_up(const std::filesystem::path& database, const std::filesystem::path& file);

/// A backup beside the database, under a name that is free: its path.
std::filesystem::path keep_copy(const std::filesystem::path& database);

/// Puts a backup in the place of a database that nobody uses. What stood there, damaged or not, is
/// kept beside it; its path is returned, empty where there was none.
std::filesystem::path restore(const std::filesystem::path& file,
                              const std::filesystem::path& database);

/// How an evaluation's key follows from the version of its engine, a line break and its question.
using Digest = std::function<std::string(std::string_view text)>;

/// What is wrong with a database, a sentence each; none where it is sound. Looks only. Keys are
/// compared with `digest`, where there is one.
std::vector<std::string> examine(const std::filesystem::path& database, const Digest& digest = {});

}  // namespace repose::db
