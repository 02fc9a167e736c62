#pragma once
// The columns of particles that are sent between ranks: those that any rank stores.
#include "core/parallel/communicator.hpp"
#include "core/particles.hpp"

namespace talus {

/// The number of ranks that store each column; a rank without particles cannot know.  Collective.
template <int D>
std::vector<std::int64_t> count_keepers(Communicator& ranks, const Particles<D>& particles)
{
  std::vector<std::int64_t> keepers;
  particles.for_each_column([&](std::string_view, std::string_view, const auto& column) { keepers.push_back(column.empty() ? 0 : 1); });
  ranks.sum(keepers);
  return keepers;
}

/// Calls f(column) for every column that some rank stores.
template <class AnyParticles, class F>
void for_each_kept_column(AnyParticles& particles, std::span<const std::int64_t> keepers, F&& f)
{
  std::size_t number = 0;
  particles.for_each_column([&](std::string_view, std::string_view, auto& column) {
    if (keepers[number++] > 0)
      f(column);
  });
}

}  // namespace talus
