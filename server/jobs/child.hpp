/// run_child(): one evaluation in a process of its own, so that a crash, an endless loop or a flood
/// of memory costs one evaluation.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>

namespace repose::server {

struct ChildResult {
  enum class End : std::uint8_t { exited, died, timed_out, cancelled };
  End end = End::exited;
  std::string output;
  std::string account;  ///< how it ended, in words
};

/// Starts `program answer`, gives it `input` and reads its standard output until it ends,
/// `time_limit` (s of wall time) has passed or a stop is asked for. Throws std::system_error where
/// no process can be started.
ChildResult run_child(const std::filesystem::path& program,
                      const std::string& input,
                      double time_limit,
                      const std::stop_token& stop);

}  // namespace repose::server
