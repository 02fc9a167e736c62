// What libFuzzer began with and what it has found since, once more, and without it.
#include <gtest/gtest.h>

#include <filesystem>

#include "io/whole_file.hpp"
#include "tests/fuzz/entries.hpp"

namespace talus::corpus_test {
namespace {

namespace fs = std::filesystem;

/// Each file of the corpus of an entry.
template <class Entry>
void replay(const std::string& name, std::size_t fewest, Entry&& entry)
{
  std::size_t played = 0;
  for (const auto& file : fs::directory_iterator(fs::path(TALUS_SOURCE_DIR) / "tests/fuzz/corpus" / name)) {
    SCOPED_TRACE(file.path());
    EXPECT_NO_THROW(entry(read_whole(file.path())));
    ++played;
  }
  EXPECT_GE(played, fewest);
}

TEST(Corpus, OfScenesIsReadOrRefused) { replay("scene", 4, fuzz_scene); }
TEST(Corpus, OfMeshesIsReadOrRefused) { replay("msh", 4, fuzz_msh); }
TEST(Corpus, OfCheckpointsIsTakenOverOrRefused) { replay("checkpoint", 4, fuzz_checkpoint); }

}  // namespace
}  // namespace talus::corpus_test
