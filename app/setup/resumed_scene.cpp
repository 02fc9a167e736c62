#include "app/setup/resumed_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "io/scene/reader.hpp"

namespace talus {

Scene read_again(const RunIdentity& run, const std::vector<std::string>& changes)
{
  const auto is_free = [](std::string_view change) {
    static constexpr std::array<std::string_view, 5> whole{"time.", "watch.", "outputs.checkpoint.", "on_exit=", "strict="};
    const auto begins = [&](std::string_view key) { return change.starts_with(key); };
    // What else a stage says it has said when it began.
    const bool of_stage = begins("stages[") && (change.find("].duration=") != change.npos || change.find("].residual=") != change.npos);
    return of_stage || std::any_of(whole.begin(), whole.end(), begins);
  };
  std::vector<SceneError> problems;
  for (const std::string& change : changes)
    if (!is_free(change))
      problems.push_back(
          {SourceLocation{"--set " + change, 0, 0, ""},
           "a run that goes on can change only what stands in time, watch and outputs.checkpoint, duration and residual of stages, "
           "on_exit and strict",
           ""});
  if (!problems.empty())
    throw SceneErrors(std::move(problems));
  std::vector<std::string> set = run.set;
  set.insert(set.end(), changes.begin(), changes.end());
  return read_scene_text(run.scene_file, run.scene_text, set);
}

void check_durations(const CheckpointList& from, const std::vector<Stage>& stages, const std::vector<std::string>& changes)
{
  const StageState& now = from.stage();
  std::vector<SceneError> problems;
  for (const std::string& change : changes) {
    const bool of_time = change.starts_with("time.end="), of_stage = change.starts_with("stages[");
    if (!of_time && !of_stage)
      continue;
    const auto number = of_time ? 0 : static_cast<Index>(std::strtol(change.c_str() + std::string_view("stages[").size(), nullptr, 10));
    const SourceLocation where{"--set " + change, 0, 0, ""};
    if (number < now.number || (number == now.number && now.done))
      problems.push_back(
          {where,
           "this stage is over: what comes after it is a scene of its own, which can begin where this run ended (initial: {from: DIR})",
           ""});
    else if (number == now.number && change.find("residual=") == change.npos &&
             now.begin + stages[static_cast<std::size_t>(number)].duration < from.clock().time)
      problems.push_back({where, fmt::format("the run is at t = {:.6g} s already", from.clock().time), ""});
  }
  if (!problems.empty())
    throw SceneErrors(std::move(problems));
}

}  // namespace talus
