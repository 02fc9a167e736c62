#pragma once
// Progress of a run: a bar on a terminal, otherwise a line every few seconds on standard error; and a file for `talus watch`.
#include <chrono>
#include <filesystem>

#include "io/output/progress_json.hpp"
#include "solver/model/model.hpp"

namespace talus {

class Progress {
 public:
  /// file: rewritten every second and removed by the destructor; none if empty.
  Progress(bool quiet, std::filesystem::path file);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Sets the work done before a run was resumed: rates and the remaining time count from here.
  void resume(Real done, Real particle_steps) noexcept { now_.done_before = done, particle_steps_before_ = particle_steps; }
  /// To be called after each step: simulated time done, total simulated time, clock of the run, particle-steps so far.
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
