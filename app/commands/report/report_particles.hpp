#pragma once
// The particles of a run as a page carries them.
#include "app/commands/report/report_plan.hpp"
#include "app/commands/report/report_survey.hpp"
#include "io/page/page.hpp"

namespace talus {

struct ParticleWishes {
  int dimension = 2;
  std::vector<PageBody> bodies;
  std::optional<std::array<Real, 2>> range;  ///< of the first field
  std::optional<std::size_t> frames;         ///< so many
  bool fields_asked_for = false;
  Real budget = 0;  ///< [B]
};

/// Puts particles into the page, as many as the budget allows, and says in its notes what is not there.  One frame at a time is held.
/// Error: see plan_page().
void add_particles(const RunSurvey& survey, const ParticleWishes& wishes, Page& page);

/// Whether a particle is one of a fair share [0, 1], which is the same whatever else is in the run.
bool is_sampled(std::int64_t id, Real share) noexcept;

}  // namespace talus
