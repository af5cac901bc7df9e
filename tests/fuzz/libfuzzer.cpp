// One target under libFuzzer; FUZZ_TARGET is its function:
//   cmake -S . -B build-fuzz -G Ninja -DCMAKE_CXX_COMPILER=clang++-14 -DREPOSE_FUZZ=ON
//   ninja -C build-fuzz fuzz_study && build-fuzz/fuzz_study -max_total_time=60
//   tests/fuzz/corpus/study
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  repose::tests::FUZZ_TARGET({reinterpret_cast<const char*>(bytes), size});
  return 0;
}
