/// What the program's exit code says.
#pragma once

namespace repose::server::exit_code {

inline constexpr int done = 0;
inline constexpr int failed = 1;   ///< the work was asked for rightly and did not succeed
inline constexpr int misused = 2;  ///< bad input or usage, or a file or address that cannot be used
inline constexpr int interrupted = 130;  ///< as shells report SIGINT: 128 + 2

}  // namespace repose::server::exit_code
