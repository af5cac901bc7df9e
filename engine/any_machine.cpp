#include "engine/any_machine.hpp"

#include <algorithm>

namespace repose::engine {

namespace {

InstructionSet best() {
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(REPOSE_SANITIZED)
  if (__builtin_cpu_supports("x86-64-v4")) return InstructionSet::avx512;
  if (__builtin_cpu_supports("x86-64-v3")) return InstructionSet::avx2;
#endif
  return InstructionSet::base;
}

InstructionSet& in_use() {
  static InstructionSet set = best();
  return set;
}

}  // namespace

InstructionSet instruction_set() { return in_use(); }

void use_instruction_set(InstructionSet set) { in_use() = std::min(best(), set); }

}  // namespace repose::engine
