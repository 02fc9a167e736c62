#pragma once
// The end of a run: summary.json, and a table on the terminal.
#include "app/observers/recorder.hpp"
#include "app/run/simulate.hpp"

namespace talus {

/// The message in the summary of a run that has not ended, or was killed.
inline constexpr auto message_before_the_end = "the run did not end";

/// A digest as text in summaries.
std::string digest_text(std::uint64_t digest);
/// The digest of the text of a scene and its changes by --set.
std::string scene_digest(const Scene& scene);

/// The summary before the first step.  Its status is "failed" until the run has ended, so that a killed run does not look finished.
template <int D>
RunSummary begin_summary(const Scene& scene, const Mesh<D>& mesh, std::uint64_t mesh_digest, const Setup<D>& setup);

/// Adds the data of the recorder.  `quick`: stages did not seek equilibrium.
template <int D>
void complete(const Recorder<D>& recorder, bool quick, RunSummary& summary);

/// Energies by stage, mass and momentum, and how far stages of the completed summary were from equilibrium, as a few lines of text that end with a line feed.
template <int D>
std::string table(const Recorder<D>& recorder, const RunSummary& summary);

}  // namespace talus
