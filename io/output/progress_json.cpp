#include "io/output/progress_json.hpp"

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

using ProgressJson = nlohmann::ordered_json;

/// Calls f(key, number) for all numbers.
template <class Progress, class F>
void for_each_number(Progress& p, F&& f)
{
  f("done [s]", p.done);
  f("total [s]", p.total);
  f("done_before [s]", p.done_before);
  f("time [s]", p.time);
  f("dt [s]", p.dt);
  f("step", p.step);
  f("elapsed [s]", p.elapsed);
  f("particle_steps_per_second", p.particle_steps_per_second);
}

}  // namespace

std::optional<Real> RunProgress::left() const noexcept
{
  const Real here = done - done_before;
  constexpr Real most = 1e12;  // largest valid time [s]
  return here > 0 ? std::optional(std::min(elapsed * std::max(total - done, 0.0) / here, most)) : std::nullopt;
}

void write_progress(const std::filesystem::path& file, const RunProgress& progress)
{
  ProgressJson json{{"stage", progress.stage}};
  for_each_number(progress, [&](const char* key, auto number) { json[key] = number; });
  write_for_now(file, json.dump(2, ' ', false, ProgressJson::error_handler_t::replace) + '\n');
}

std::optional<RunProgress> read_progress(const std::filesystem::path& file)
try {
  if (!std::filesystem::exists(file))
    return std::nullopt;
  const ProgressJson json = ProgressJson::parse(read_whole(file));
  RunProgress progress;
  progress.stage = json.at("stage").get<std::string>();
  bool fit = true;
  for_each_number(progress, [&](const char* key, auto& number) {
    constexpr Real most = 1e15;  // largest valid count
    const Real value = json.at(key).get<Real>();
    fit = fit && value >= 0 && value < most;
    if (fit)
      number = static_cast<std::remove_reference_t<decltype(number)>>(value);
  });
  return fit ? std::optional(progress) : std::nullopt;
} catch (const ProgressJson::exception&) {
  return std::nullopt;
} catch (const EnvironmentError&) {  // the file was removed in the meantime
  return std::nullopt;
}

}  // namespace talus
