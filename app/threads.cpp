#include "app/threads.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "core/exchange.hpp"
#include "core/parallel.hpp"
#include "io/scene.hpp"

namespace talus {

int threads_that_pay(Index particles, int available) noexcept
{
  return static_cast<int>(std::clamp<Index>(particles / particles_of_a_thread, 1, std::max(1, available)));
}

void fit_threads(std::optional<int> asked, const Scene& scene, Index particles)
{
  const bool named = asked || scene.threads > 0 || std::getenv("OMP_NUM_THREADS") != nullptr;
  if (!named)
    set_threads(threads_that_pay(particles / world().size(), threads()));
}

void let_waiting_threads_sleep_soon(char** arguments) noexcept
{
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr || threads() == 1)
    return;
  std::error_code unknown;
  const std::filesystem::path self =
      std::filesystem::read_symlink("/proc/self/exe", unknown);            // by its name, which lists of processes show
  const bool by_the_loader = self.filename().string().starts_with("ld-");  // called by name: it would be what is begun again
  if (!unknown && !by_the_loader && ::setenv("GOMP_SPINCOUNT", "1000", 1) == 0)
    ::execv(self.c_str(), arguments);
}

}  // namespace talus
