#include "app/run/run_phases.hpp"

#include <algorithm>

namespace talus {

std::vector<NamedValue> wall_by_phase(const RunPhases& phases, const Timings& in_steps, Real output, Real checkpoints)
{
  std::vector<NamedValue> all;
  const auto add = [&](const char* name, Real seconds) { all.push_back({name, seconds, ""}); };
  add("mesh", phases.mesh);
  add("seeding", phases.seeding);
  add("kernel", phases.kernel);
  add("build", phases.build);
  add("first_files", phases.first_files);
  add("initial_stress", phases.initial_stress);
  add("locate", in_steps.locate);
  add("scatter", in_steps.scatter);
  add("nodes", in_steps.nodes);
  add("gather", in_steps.gather);
  add("stress", in_steps.stress);
  add("output", output);
  add("checkpoints", checkpoints);
  add("monitoring", std::max(Real{0}, phases.observers - output - checkpoints - phases.script));
  if (phases.script > 0)
    add("script", phases.script);
  if (phases.rebalancing > 0)
    add("rebalancing", phases.rebalancing);
  return all;
}

}  // namespace talus
