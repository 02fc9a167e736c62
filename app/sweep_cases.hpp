#pragma once
// The cases of a study: their scenes, what is wrong with them before anything runs, and how far each has come.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/study.hpp"
#include "io/summary_json.hpp"

namespace talus {

struct SweepCase {
  int number;  ///< from 1
  StudyCase values;
  std::vector<std::string> changes;  ///< as --set takes them
  std::filesystem::path folder;
  std::string scene_digest, mesh_digest;  ///< what its run would be made from now; that of the mesh empty where nobody asked for it
};

/// What is to be done with the cases of a study, and where.
struct SweepPlan {
  Study study;
  std::filesystem::path folder;
  bool quick = false;
  std::vector<SweepCase> cases;
  std::vector<std::string> fronts;  ///< of the histories of any case: how far bodies run out
};

/// Reads the scene of every case.  SceneErrors: all that is wrong with any of them, at the value in the study that made it so.
SweepPlan plan_sweep(Study study, std::filesystem::path folder, bool quick);

enum class CaseState : std::uint8_t { to_run, not_ended, stopped, failed, done };
constexpr std::array<std::string_view, 5> words(CaseState) { return {"to be run", "not ended", "stopped", "failed", "done"}; }

/// What the folder of a case says of it.
struct CaseStatus {
  CaseState state = CaseState::to_run;
  std::string why;                   ///< results there are not of this case; or a run failed with this message
  std::optional<Real> goes_on_from;  ///< time of the newest checkpoint of this case [s]
  SummaryBack summary;               ///< of this case only
};

/// Results that were made from another text, other changes or another mesh (where its digest is known) are not those of the case.
CaseStatus status_of(const SweepCase& one, bool quick);

/// Another process is writing there now, as far as the file system knows.
bool is_at_work(const SweepCase& one);

enum class CheckDepth : std::uint8_t { mesh, all };
/// Makes or reads the meshes of these cases and sets their digests; with `all` builds the model of each that would begin anew.  SceneErrors
/// with all that is wrong.
void check_cases(SweepPlan& plan, const std::vector<std::size_t>& chosen, CheckDepth depth);

/// "materials[0].cohesion=20e3, mesh.size=0.1"
std::string in_words(const SweepCase& one);

}  // namespace talus
