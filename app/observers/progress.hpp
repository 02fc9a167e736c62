#pragma once
// How far a run is: on standard error a bar on a terminal, a line every few seconds elsewhere; and in a file for `talus watch`.
#include <chrono>
#include <filesystem>

#include "io/output/progress_json.hpp"
#include "solver/model/model.hpp"

namespace talus {

class Progress {
 public:
  /// file: rewritten every second and gone when this is; none if empty.
  Progress(bool quiet, std::filesystem::path file);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// A run that goes on has done this much already: rates and the time that is left count from here.
  void resume(Real done, Real particle_steps) noexcept { now_.done_before = done, particle_steps_before_ = particle_steps; }
  /// After each step: simulated time that is done, out of the total; the clock of the run; particle steps so far.
  void step(Real done, Real total, const Clock& clock, std::string_view stage, Real particle_steps);

 private:
  using Watch = std::chrono::steady_clock;
  void draw(bool last);

  RunProgress now_;
  Real particle_steps_before_ = 0;
  bool quiet_, terminal_;
  bool drawn_ = false;
  std::filesystem::path file_;
  Watch::time_point start_ = Watch::now(), drawn_at_ = start_;
  std::optional<Watch::time_point> written_at_;
};

}  // namespace talus
