/// FileLock: one process at a time writes a database.
#pragma once

#include <filesystem>

namespace repose::db {

/// Holds `<database>.lock` for as long as it lives. Throws db::Error, naming the holder, where
/// another process has it. The lock ends with the process, however that ends.
class FileLock {
 public:
  explicit FileLock(const std::filesystem::path& database);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace repose::db
