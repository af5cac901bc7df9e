/// AnyMachine: runs a hot function compiled for the best instruction set of the machine at hand.
/// One binary is fast everywhere, and bits are equal on all sets, since nothing is contracted.
#pragma once

#include <array>
#include <string_view>

namespace repose::engine {

/// Instruction sets of x86-64 with vectors of 2, 4 and 8 doubles; `base` is also every other
/// machine's.
enum class InstructionSet { base, avx2, avx512 };

inline constexpr std::array<std::string_view, 3> instruction_set_names{"base", "avx2", "avx512"};

/// The best one of this machine, or the last one asked for.
InstructionSet instruction_set();
/// Asks for one, before any run; a machine that lacks it keeps its best.
void use_instruction_set(InstructionSet set);

// clang 14 refuses the attributes.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(REPOSE_SANITIZED)
#define REPOSE_TARGET(arch) [[gnu::target("arch=" arch), gnu::flatten]]
#else
#define REPOSE_TARGET(arch)
#endif

/// `call` runs `body`, an inline function without a target of its own.
template <auto body>
struct AnyMachine;

template <class... A, void (*body)(A...)>
struct AnyMachine<body> {
  static void call(A... arguments) {
    switch (instruction_set()) {
      case InstructionSet::base:
        return base(arguments...);
      case InstructionSet::avx2:
        return avx2(arguments...);
      case InstructionSet::avx512:
        return avx512(arguments...);
    }
  }

 private:
  static void base(A... arguments) { body(arguments...); }
  REPOSE_TARGET("x86-64-v3") static void avx2(A... arguments) { body(arguments...); }
  REPOSE_TARGET("x86-64-v4") static void avx512(A... arguments) { body(arguments...); }
};

}  // namespace repose::engine
