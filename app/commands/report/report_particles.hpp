#pragma once
// The particles of a run in a page.
#include "app/commands/report/report_plan.hpp"
#include "app/commands/report/report_rigid.hpp"
#include "app/commands/report/report_survey.hpp"
#include "io/page/page.hpp"

namespace talus {

struct ParticleWishes {
  int dimension = 2;
  std::vector<PageBody> bodies;
  std::optional<std::array<Real, 2>> range;  ///< range of the first field
  std::optional<std::size_t> frames;         ///< number of frames
  bool fields_asked_for = false;
  Real budget = 0;    ///< largest size [B]
  RigidFrames rigid;  ///< which every frame has as well
};

/// Adds particles to the page, as many as the budget allows, and notes what is left out.  Only one frame at a time is in memory.  Throws
/// Error, see plan_page().
void add_particles(const RunSurvey& survey, const ParticleWishes& wishes, Page& page);

/// Whether a particle belongs to a random sample of a given fraction; independent of other particles.
bool is_sampled(std::int64_t id, Real share) noexcept;

}  // namespace talus
