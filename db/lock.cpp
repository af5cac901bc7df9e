#include "db/lock.hpp"

#include <array>
#include <cerrno>
#include <fcntl.h>
#include <string>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>

#include "db/store.hpp"

namespace repose::db {

FileLock::FileLock(const std::filesystem::path& database) {
  const std::string file = database.string() + ".lock";
  descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor_ < 0) {
    throw Error(0,
                "cannot make " + file + ": " + std::generic_category().message(errno) +
                    "; check that the folder exists and that you may write there");
  }
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    std::array<char, 32> holder{};
    const ssize_t length = pread(descriptor_, holder.data(), holder.size() - 1, 0);
    close(descriptor_);
    const std::string process = length > 0 ? std::string(holder.data()) : "another program";
    throw Error(0,
                "database " + database.string() + " is in use by process " + process +
                    "; ask it (repose serve answers over HTTP), end it, or choose another file "
                    "with --db");
  }
  const std::string self = std::to_string(getpid());
  if (ftruncate(descriptor_, 0) != 0 ||
      pwrite(descriptor_, self.data(), self.size(), 0) != static_cast<ssize_t>(self.size())) {
    const int cause = errno;
    close(descriptor_);
    throw Error(0, "cannot write " + file + ": " + std::generic_category().message(cause));
  }
}

FileLock::~FileLock() { close(descriptor_); }

}  // namespace repose::db
