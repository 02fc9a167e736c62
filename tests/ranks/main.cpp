// Tests that several ranks run together, started by mpirun.  The root prints as usual, the others only what fails.
#include <gtest/gtest.h>

#include <iostream>

#include "core/parallel/communicator.hpp"

namespace {

class FailuresOnly : public testing::EmptyTestEventListener {
  void OnTestPartResult(const testing::TestPartResult& result) override
  {
    if (result.failed())
      std::cout << "rank " << talus::world().rank() << ": " << result.file_name() << ":" << result.line_number() << ": " << result.message()
                << std::endl;
  }
};

}  // namespace

int main(int argc, char** argv)
{
  talus::Ranks ranks;
  testing::InitGoogleTest(&argc, argv);
  if (!talus::world().is_root()) {
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailuresOnly);
  }
  return ranks.end(RUN_ALL_TESTS());
}
