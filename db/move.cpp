#include "db/move.hpp"

#include <cerrno>
#include <fcntl.h>
#include <string>
#include <system_error>
#include <unistd.h>

#include "db/store.hpp"

namespace repose::db {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& doing, const std::error_code& problem) {
  throw Error(0, doing + ": " + problem.message());
}

/// Not every file system can be asked to.
void sync_folder(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool synced = descriptor >= 0 && (fsync(descriptor) == 0 || errno == EINVAL);
  const std::error_code problem(errno, std::generic_category());
  if (descriptor >= 0) close(descriptor);
  if (!synced) fail("cannot write the folder " + folder.string(), problem);
}

}  // namespace

void move_to(const fs::path& from, const fs::path& to) {
  std::error_code problem;
  fs::rename(from, to, problem);
  if (problem) fail("cannot give " + from.string() + " the name " + to.string(), problem);
  sync_folder(fs::absolute(to).parent_path());
}

}  // namespace repose::db
