// What libFuzzer began with and what it has found since, once more, and without it.
#include <gtest/gtest.h>

#include <filesystem>

#include "io/files/atomic_file.hpp"
#include "tests/fuzz/entries.hpp"

namespace talus::corpus_test {
namespace {

namespace fs = std::filesystem;

class Corpus : public testing::TestWithParam<FuzzEntry> {};

TEST_P(Corpus, IsReadOrRefused)
{
  std::size_t played = 0;
  for (const auto& file : fs::directory_iterator(fs::path(TALUS_SOURCE_DIR) / "tests/fuzz/corpus" / GetParam().name)) {
    SCOPED_TRACE(file.path());
    EXPECT_NO_THROW(GetParam().take(read_whole(file.path())));
    ++played;
  }
  EXPECT_GE(played, 2u);
}

INSTANTIATE_TEST_SUITE_P(Of, Corpus, testing::ValuesIn(fuzz_entries), [](const auto& entry) { return std::string(entry.param.name); });

}  // namespace
}  // namespace talus::corpus_test
