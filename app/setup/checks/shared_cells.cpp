#include "app/setup/checks/shared_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace talus {

namespace {

/// Whether two bodies are there in the same stage.
bool meet(const Scene& scene, const std::string& a, const std::string& b)
{
  const Presence one = presence_of(a, scene.stages), other = presence_of(b, scene.stages);
  return one.from < other.until && other.from < one.until;
}

}  // namespace

void warn_of_shared_cells(const Scene& scene, const std::vector<Body>& bodies, std::span<const Index> cell, Index n_cells,
                          Communicator& ranks, std::vector<std::string>& warnings)
{
  constexpr std::int64_t most = 10;
  std::vector<Index> owner(static_cast<std::size_t>(n_cells), none), counted(owner);
  std::int64_t pairs = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::vector<std::int64_t> shared(b, 0);
    for (Index row = bodies[b].begin; row < bodies[b].end; ++row) {
      const auto c = static_cast<std::size_t>(cell[static_cast<std::size_t>(row)]);
      const Index body = static_cast<Index>(b), holds = owner[c];
      if (holds == none)
        owner[c] = body;
      else if (holds != body && std::exchange(counted[c], body) != body)
        ++shared[static_cast<std::size_t>(holds)];
    }
    ranks.sum(shared);  // no cell is filled by two ranks
    for (std::size_t other = 0; other < b; ++other)
      if (shared[other] > 0 && meet(scene, bodies[other].name, bodies[b].name) && ++pairs <= most)
        warnings.push_back(fmt::format("{}: bodies \"{}\" and \"{}\" share {} cell{} at the start", to_string(bodies[b].where),
                                       bodies[other].name, bodies[b].name, shared[other], shared[other] == 1 ? "" : "s"));
  }
  if (pairs > most)
    warnings.push_back(fmt::format("{} more pairs of bodies share cells at the start", pairs - most));
}

void find_groups_filled_twice(const Scene& scene, SceneErrorCollector& errors)
{
  std::map<std::string, std::vector<const BodySpec*>> filled;
  for (const BodySpec& body : scene.bodies) {
    if (body.region.empty())
      continue;
    std::vector<const BodySpec*>& before = filled[body.region];
    const auto at_once =
        std::find_if(before.begin(), before.end(), [&](const BodySpec* other) { return meet(scene, body.name, other->name); });
    if (at_once != before.end())
      errors.add(body.where, "region", fmt::format("body \"{}\" fills the cell group \"{}\" already", (*at_once)->name, body.region));
    before.push_back(&body);
  }
}

}  // namespace talus
