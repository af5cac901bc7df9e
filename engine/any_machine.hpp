/// REPOSE_ANY_MACHINE: compiles a function for three instruction sets; the loader picks one. One
/// binary is fast everywhere, and bits are equal on all, since nothing is contracted.
#pragma once

// clang 14 refuses the attribute, and the sanitizers' start-up cannot resolve it.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(REPOSE_SANITIZED)
#define REPOSE_ANY_MACHINE \
  __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4"), flatten))
#else
#define REPOSE_ANY_MACHINE
#endif
