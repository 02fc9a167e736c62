#include "app/run/thread_choice.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "core/parallel/communicator.hpp"
#include "core/parallel/threads.hpp"
#include "io/scene/scene.hpp"

namespace talus {

int threads_that_pay(Index particles, int available) noexcept
{
  return static_cast<int>(std::clamp<Index>(particles / particles_of_a_thread, 1, std::max(1, available)));
}

ThreadChoice::ThreadChoice() : ThreadChoice(talus::threads(), talus::threads(), talus::threads()) {}

ThreadChoice::ThreadChoice(int first, int least, int most) : kept_(first), least_(least), most_(most) {}

void ThreadChoice::begin_trial()
{
  tried_ = {kept_};
  for (const int other : {kept_ / 2, 2 * kept_})
    if (const int n = std::clamp(other, least_, most_); n != kept_)
      tried_.push_back(n);
  took_.assign(tried_.size(), {});
  trying_ = tried_.size() > 1;
  turn_ = 0;
}

void ThreadChoice::end_trial()
{
  constexpr Real worth_it = 0.9;  // smaller differences may be random
  const auto median = [](std::vector<Real>& seconds) {
    const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
    std::nth_element(seconds.begin(), middle, seconds.end());
    return *middle;
  };
  Real least = worth_it * median(took_[0]);
  for (std::size_t k = 1; k < tried_.size(); ++k)
    if (const Real seconds = median(took_[k]); seconds < least)
      least = seconds, kept_ = tried_[k];
  trying_ = false;
  since_ = 0;
}

void ThreadChoice::took(Real seconds)
{
  constexpr std::int64_t between_trials = 200;  // with three steps of each, a trial costs some per cent of the time
  constexpr std::size_t turns = 3;
  if (trying_) {
    took_[turn_ % tried_.size()].push_back(seconds);
    if (++turn_ == turns * tried_.size())
      end_trial();
  } else if (++since_ == between_trials || (turn_ == 0 && since_ == turns)) {  // the first steps allocate arrays
    begin_trial();
  }
}

ThreadChoice fit_threads(std::optional<int> asked, const Scene& scene, Index particles)
{
  const bool named = asked || scene.threads > 0 || std::getenv("OMP_NUM_THREADS") != nullptr;
  const int most = threads();
  if (!named)
    set_threads(threads_that_pay(particles / world().size(), most));
  // With more particles all threads pay whatever else the machine does; with fewer, one.
  const Index sure = 20 * particles_of_a_thread * most, hopeless = particles_of_a_thread / 10;
  if (named || !world().alone() || particles > sure || particles < hopeless)
    return {};
  return {threads(), 1, most};
}

void let_waiting_threads_sleep_soon(char** arguments) noexcept
{
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr || threads() == 1)
    return;
  std::error_code unknown;
  const std::filesystem::path self =
      std::filesystem::read_symlink("/proc/self/exe", unknown);            // by its name, which lists of processes show
  const bool by_the_loader = self.filename().string().starts_with("ld-");  // run by the loader, which would be restarted
  if (!unknown && !by_the_loader && ::setenv("GOMP_SPINCOUNT", "1000", 1) == 0)
    ::execv(self.c_str(), arguments);
}

}  // namespace talus
