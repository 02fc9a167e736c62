// The side of libFuzzer: TALUS_FUZZ_ENTRY is one of the functions in entries.hpp.
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/entries.hpp"

// HDF5 leaves some bytes behind of a file that it finds damaged.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  talus::TALUS_FUZZ_ENTRY({reinterpret_cast<const char*>(data), size});
  return 0;
}
