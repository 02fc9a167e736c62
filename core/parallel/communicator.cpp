// Start and end of the MPI ranks.
#include "core/parallel/communicator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <utility>

#include "core/parallel/mpi_calls.hpp"

namespace talus {

namespace {

/// Environment variables that launchers set for each rank: Open MPI, MPICH, PMIx.
constexpr std::array launch_variables{"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMI_RANK", "PMIX_RANK"};

bool in_environment(const char* variable)
{
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

/// The number of ranks that the launcher says it has started.
std::optional<int> launched()
{
  for (const char* const variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"})
    if (in_environment(variable))
      return std::atoi(std::getenv(variable));
  return std::nullopt;
}

}  // namespace

void check_mpi(int result, const char* call)
{
  if (result == MPI_SUCCESS)
    return;
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(result, text.data(), &length);
  throw EnvironmentError(fmt::format("{} failed: {}", call, std::string_view(text.data(), static_cast<std::size_t>(length))));
}

bool launched_as_ranks() { return std::ranges::any_of(launch_variables, in_environment); }

void forget_launch() noexcept
{
  for (const char* const variable : launch_variables)
    ::unsetenv(variable);
}

int ranks_on_this_machine()
{
  for (const char* const variable : {"OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS", "SLURM_NTASKS_PER_NODE"})
    if (const char* const text = std::getenv(variable))
      return std::max(1, std::atoi(text));
  return 1;
}

Communicator::Communicator() noexcept = default;
Communicator::Communicator(Communicator&&) noexcept = default;
Communicator& Communicator::operator=(Communicator&&) noexcept = default;
Communicator::~Communicator() = default;
Communicator::Communicator(std::unique_ptr<Group> group) noexcept : group_(std::move(group))
{
  MPI_Comm_rank(group_->comm, &rank_);
  MPI_Comm_size(group_->comm, &size_);
}

void Communicator::abort(int code) const noexcept
{
  std::fflush(nullptr);
  if (group_)
    MPI_Abort(MPI_COMM_WORLD, code);
  std::_Exit(code);
}

Communicator& one_rank()
{
  static Communicator exchange;
  return exchange;
}

Communicator& world()
{
  static Communicator exchange;
  return exchange;
}

bool goes_on_as_root()
{
  const bool is_root = world().is_root();
  world() = Communicator();
  return is_root;
}

Ranks::Ranks()
{
  if (!launched_as_ranks())
    return;
  int level = MPI_THREAD_SINGLE;
  check_mpi(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level), "MPI_Init_thread");
  running_ = true;
  world() = Communicator(std::make_unique<Communicator::Group>());
  const int found = world().size();
  std::string wrong;
  if (level < MPI_THREAD_FUNNELED)
    wrong = "this MPI cannot be used by a program with threads (MPI_THREAD_FUNNELED)";
  else if (launched().value_or(found) != found)
    wrong = fmt::format("the launcher has started {} ranks, MPI finds {}: the program was built with another MPI than the launcher's",
                        *launched(), found);
  if (!wrong.empty()) {
    end(0);
    throw EnvironmentError(wrong);
  }
}

int Ranks::end(int code, const char* message) noexcept
{
  const int rank = world().rank();
  const auto say = [&] {
    std::fflush(stdout);
    if (message != nullptr && rank == 0)
      std::fprintf(stderr, "%s\n", message);
    else if (message != nullptr)
      std::fprintf(stderr, "rank %d: %s\n", rank, message);
  };
  if (rank == 0)
    say();
  if (!std::exchange(running_, false))
    return code;
  MPI_Request all_here = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &all_here);  // not one of the collectives that other ranks may be waiting in
  if (code == 0) {
    for (int done = 0; MPI_Test(&all_here, &done, MPI_STATUS_IGNORE) == MPI_SUCCESS && done == 0;)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } else if (!within_patience([&](int& done) { return MPI_Test(&all_here, &done, MPI_STATUS_IGNORE); })) {
    if (rank != 0)
      say();
    world().abort(code);
  }
  if (world().group_ && world().group_->torn)
    world().abort(code);
  world() = Communicator();
  MPI_Finalize();
  return code;
}

Ranks::~Ranks() { end(std::uncaught_exceptions() > 0 ? 1 : 0); }

}  // namespace talus
