// The side of libFuzzer.  One program for all entries: each is called by a name of its own, talus_fuzz_<entry>.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/entries.hpp"

namespace {

const talus::FuzzEntry* chosen = nullptr;

}  // namespace

// HDF5 leaves some bytes behind of a file that it finds damaged.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

extern "C" int LLVMFuzzerInitialize(int*, char*** arguments)
{
  const std::string_view program = **arguments;
  for (const talus::FuzzEntry& entry : talus::fuzz_entries)
    if (program.ends_with("talus_fuzz_" + std::string(entry.name)))
      chosen = &entry;
  if (chosen != nullptr)
    return 0;
  std::fprintf(stderr, "this program is called by the name of an entry, talus_fuzz_<entry>:");
  for (const talus::FuzzEntry& entry : talus::fuzz_entries)
    std::fprintf(stderr, " %s", entry.name);
  std::fprintf(stderr, "\n");
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  chosen->take({reinterpret_cast<const char*>(data), size});
  return 0;
}
