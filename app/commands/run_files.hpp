#pragma once
// What a run writes at its beginning, with a copy of its scene, and the identity of its program, scene, mesh and files, by which it can go on.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/observers/checkpoints.hpp"
#include "io/output/run_summary.hpp"
#include "io/scene/scene.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Whether a run continues in the results folder of the run that it resumes.
bool goes_on_in_place(const CheckpointList* from, const std::filesystem::path& folder);

/// Why a run cannot write into a folder: it would replace a file that it reads.
std::string replaces_source(const std::filesystem::path& source, const std::filesystem::path& folder);
/// Throws SceneErrors if the table of a body lies among the results that the run would replace.
void check_start_tables(const Scene& scene, const std::vector<StartStateSummary>& starts, const std::filesystem::path& folder);

/// Writes summary, mesh and initial state at the start.  An existing mesh file is kept: it is that of the run, or was changed by the user.
/// `initial`: the file of the initial state, which is copied.
template <int D>
void write_first_files(const std::filesystem::path& place, const RunSummary& summary, const Mesh<D>& mesh,
                       const std::optional<std::filesystem::path>& initial);

/// The identity for this program and a scene; `mesh` and `from_files` are digests, `initial` is the file of the initial state, or empty.
RunIdentity identity_of(const Scene& scene, bool quick, std::uint64_t mesh, std::uint64_t from_files, const std::string& initial);

/// Throws EnvironmentError if the mesh, or the contents of other files, differ from those of the checkpoint.  Another program leads to a
/// warning.
void compare(const RunIdentity& then, const RunIdentity& now);

inline constexpr auto scene_copy_file = "scene.yaml";

/// The text of a scene, with the changes by --set as comments at its end.
std::string with_changes(const std::string& text, const std::vector<std::string>& changes);

/// Updates the scene in the folder of a resumed run.  An edited copy is not changed.
void update_scene_copy(const std::filesystem::path& folder, const Scene& scene);

/// Warnings about edits.  A run is resumed with the scene in its checkpoint, `text` with `changes`; later edits of the original file or of
/// the copy in its folder are ignored.
std::vector<std::string> find_edits(const std::filesystem::path& scene_file, const std::optional<std::filesystem::path>& folder,
                                    const std::string& text, const std::vector<std::string>& changes);

}  // namespace talus
