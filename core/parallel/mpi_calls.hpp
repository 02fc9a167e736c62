#pragma once
// Declarations for the sources of the communicator: MPI, its errors as exceptions, and the contents of a communicator and of its messages.
#define OMPI_SKIP_MPICXX 1  // NOLINT(readability-identifier-naming): MPI's name for leaving out its old C++ classes
#include <mpi.h>

#include <chrono>
#include <thread>

#include "core/error.hpp"
#include "core/parallel/communicator.hpp"

namespace talus {

struct Communicator::Group {
  Group()
  {
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);  // which the copy inherits
    if (MPI_Comm_dup(MPI_COMM_WORLD, &comm) != MPI_SUCCESS)
      throw EnvironmentError("MPI_Comm_dup failed");
  }
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;
  ~Group() { MPI_Comm_free(&comm); }

  MPI_Comm comm = MPI_COMM_NULL;
  bool torn = false;  ///< messages were cancelled, so MPI_Finalize might wait for them
};

struct PendingMessages::Requests {
  struct Expected {
    int rank, bytes;
    bool at_most;
  };
  std::vector<MPI_Request> request;  ///< receives, then sends
  std::vector<Expected> expected;    ///< expected length of each receive
  std::vector<MPI_Status> status;
  bool* torn = nullptr;
};

/// Tags of the messages of collective calls.
inline constexpr int gather_tag = Communicator::tags, all_to_all_tag = Communicator::tags + 1;

/// Throws EnvironmentError with the name of the call if the result is an error.
void check_mpi(int result, const char* call);

/// Tests repeatedly whether test(done) succeeds, for as long as ranks that fail for the same reason may be apart in time.
template <class F>
bool within_patience(F&& test)
{
  const auto last = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  for (;;) {
    int done = 0;
    if (test(done) != MPI_SUCCESS)
      return false;
    if (done != 0)
      return true;
    if (std::chrono::steady_clock::now() > last)
      return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace talus
