/// The program `repose` that is tested: the one beside the test program, so that the watched tests
/// start the watched one.
#pragma once

#include <filesystem>
#include <string>

namespace repose::tests {

inline const std::string repose_program =
    std::filesystem::read_symlink("/proc/self/exe").replace_filename("repose").string();

}  // namespace repose::tests
