/// run_child(): one evaluation in a process of its own, so that a crash, an endless loop or a flood
/// of memory costs one evaluation.
///
/// The process reads a question to its end, and writes an answer. While it works it writes a line
/// break every `beat`, which JSON takes no notice of: one that falls silent is lost.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>

namespace repose::server {

inline constexpr std::chrono::seconds beat{2};  ///< of wall time
/// With which a process says that it was given no more memory (ENOMEM).
inline constexpr int out_of_memory_code = 12;

/// Whether ChildLimits::bytes is kept to: not under a sanitizer, whose shadow memory passes any
/// limit.
extern const bool limits_memory;

/// What a process may take.
struct ChildLimits {
  double seconds = 3600.0;  ///< of wall time
  double silence = 30.0;    ///< s of wall time without a sign of life
  std::uint64_t bytes = 0;  ///< of address space; 0: any
};

struct ChildResult {
  enum class End : std::uint8_t { exited, died, timed_out, silent, cancelled };
  End end = End::exited;
  std::string output;
  int exit_code = 0;    ///< of one that exited
  std::string account;  ///< how it ended, in words
};

/// Starts `program answer`, gives it `input` and reads its standard output until it ends, passes a
/// limit or a stop is asked for. Throws std::system_error where no process can be started.
ChildResult run_child(const std::filesystem::path& program,
                      const std::string& input,
                      const ChildLimits& limits,
                      const std::stop_token& stop);

}  // namespace repose::server
