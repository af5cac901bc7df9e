/// The command line: reads it, calls one command, gives the exit code (0 done, 1 failed, 2 bad
/// input or usage, 130 interrupted).
#pragma once

namespace repose::server {

int run_command_line(int argc, const char* const* argv);

}  // namespace repose::server
