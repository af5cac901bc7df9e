/// The verification table: what the engine gave beside what it should have given, case by case.
///
///   REPOSE_VERIFICATION_TABLE=1 build/engine_tests "[verification]"   prints it, in Markdown
#pragma once

#include <string>

namespace repose::tests {

/// How far a result may be from its reference.
struct Tolerance {
  double size;
  bool relative;
};
constexpr Tolerance relative(double size) { return {size, true}; }
constexpr Tolerance absolute(double size) { return {size, false}; }

/// Checks one result, and prints its line where the table is asked for.
void verify(const std::string& name, double reference, double got, Tolerance tolerance);

/// Prints the line of a result that has a reference but is not held to it.
void report(const std::string& name, double reference, double got);

}  // namespace repose::tests
