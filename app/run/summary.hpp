#pragma once
// What a run says in the end: summary.json, and a table for people.
#include "app/observers/recorder.hpp"
#include "app/run/simulate.hpp"

namespace talus {

/// What a summary says of a run that has not ended, or was killed.
inline constexpr auto message_before_the_end = "the run did not end";

/// A digest as summaries write it.
std::string digest_text(std::uint64_t digest);
/// Of the text of a scene and what --set changed of it.
std::string scene_digest(const Scene& scene);

/// What is known before the first step.  Its status is "failed" until the run has ended, so that a killed run does not look finished.
template <int D>
RunSummary begin_summary(const Scene& scene, const Mesh<D>& mesh, std::uint64_t mesh_digest, const Setup<D>& setup);

/// Adds what the recorder has seen.  `quick`: stages did not look for equilibrium.
template <int D>
void complete(const Recorder<D>& recorder, bool quick, RunSummary& summary);

/// Energies by stage, mass and momentum, in a few lines ending in a line feed.
template <int D>
std::string table(const Recorder<D>& recorder);

extern template RunSummary begin_summary<2>(const Scene&, const Mesh<2>&, std::uint64_t, const Setup<2>&);
extern template RunSummary begin_summary<3>(const Scene&, const Mesh<3>&, std::uint64_t, const Setup<3>&);
extern template void complete<2>(const Recorder<2>&, bool, RunSummary&);
extern template void complete<3>(const Recorder<3>&, bool, RunSummary&);
extern template std::string table<2>(const Recorder<2>&);
extern template std::string table<3>(const Recorder<3>&);

}  // namespace talus
