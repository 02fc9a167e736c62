// Reading of checkpoints; they are written in write_checkpoints.cpp.
#include "app/observers/checkpoints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "app/observers/checkpoint_files.hpp"
#include "app/observers/checkpoint_layout.hpp"
#include "app/observers/rank_slices.hpp"
#include "app/observers/results.hpp"
#include "app/observers/validate_state.hpp"
#include "io/checkpoint/serialize.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// Restricts the bodies to the rows [first, end) of the file, which then count from 0.
void take_slice(std::int64_t first, std::int64_t end, std::vector<Body>& bodies)
{
  for (Body& body : bodies) {
    body.begin = static_cast<Index>(std::clamp<std::int64_t>(body.begin, first, end) - first);
    body.end = static_cast<Index>(std::clamp<std::int64_t>(body.end, first, end) - first);
  }
}

/// A law of the user from another library than that of the checkpoint goes on with the history of that one: its author has to know whether it can.
void warn_of_library(const ArrayReader& file, std::size_t b, const std::string& body, const ConstitutiveLaw& law)
{
  if (const std::string digest = law.library_digest(); !digest.empty() && world().is_root())
    if (const std::string there = file.text(below("laws/library", b)); there != digest)
      fmt::print(stderr,
                 "warning: body \"{}\" goes on with another library: the law {} has the digest {}, and that of the checkpoint had {}\n",
                 body, law.name(), digest, there);
}

void recall_laws(const ArrayReader& file, const std::vector<Body>& in_file, const std::vector<Body>& here, std::int64_t first,
                 std::vector<Material>& materials)
{
  for (std::size_t b = 0; b < materials.size(); ++b) {
    const Body &all = in_file[b], &body = here[b];
    if (const std::string name = file.text(below("laws/name", b)); name != materials[b].law().name())
      throw EnvironmentError(
          fmt::format("the law of body \"{}\" is {} there and {} in the scene", body.name, name, materials[b].law().name()));
    warn_of_library(file, b, body.name, materials[b].law());
    materials[b].set_range(body);
    const Slice rows = rows_of_body(all, body, {first});
    recall_history(file, history_of(b), static_cast<std::size_t>(rows.first), static_cast<std::size_t>(all.size()), materials[b]);
  }
}

/// Checks that the columns exist that set-up has chosen; every state of the same scene with particles has the same columns.
template <int D>
std::vector<bool> filled_columns(const Particles<D>& particles)
{
  std::vector<bool> there;
  particles.for_each_column([&](std::string_view, std::string_view, const auto& column) { there.push_back(!column.empty()); });
  return there;
}

void must(bool holds, const char* what)
{
  if (!holds)
    throw EnvironmentError(fmt::format("its {} do not fit the scene", what));
}

/// Checks the length of a list against set-up before its items are replaced, because some members of items are not stored.
void check_count(const ArrayReader& arrays, const std::string& list, std::size_t n, const char* what)
{
  std::int64_t count = 0;
  load(arrays, below(list, "count"), count);
  must(std::cmp_equal(count, n), what);
}

/// Reads bodies, particles and histories: the rows in the slice of one of several ranks, with bodies of that slice.  Checks that bodies are
/// contiguous, that all columns have equal numbers of rows, and that the necessary columns exist.  Returns the number of rows over all
/// ranks.
template <int D>
std::int64_t recall_slice(const ArrayReader& arrays, int rank, int ranks, std::vector<Body>& bodies, std::vector<Material>& materials,
                          Particles<D>& particles)
{
  load(arrays, "bodies", bodies);
  Index end = 0;
  for (const Body& body : bodies) {
    must(body.begin == end && body.end >= end, "bodies");
    end = body.end;
  }
  must(std::cmp_equal(end, arrays.rows("particles/id")), "bodies");
  const std::vector<Body> in_file = bodies;
  const Slices slices{end, ranks};
  const std::int64_t first = slices.begin(rank);
  const std::size_t n = slices.size(rank);
  take_slice(first, slices.end(rank), bodies);
  particles.for_each_column([&](std::string_view name, std::string_view, const auto&) {
    const std::size_t rows = arrays.rows(below("particles", name));
    must(rows == 0 || std::cmp_equal(rows, end), "columns");
  });
  recall_columns(arrays, "particles", static_cast<std::size_t>(first), n, particles);
  const auto all_there = [n](const auto&... columns) { return ((columns.size() == n) && ...); };
  const Particles<D>& p = particles;
  must(all_there(p.cell, p.x, p.v, p.L, p.F, p.stress, p.mass, p.volume0, p.volume), "columns");
  recall_laws(arrays, in_file, bodies, first, materials);
  return end;
}

/// Throws EnvironmentError for a state that no run of the scene can have.  Digests show that a file is unchanged, not who wrote it.
template <int D>
void check_sizes(const State<D>& state, const std::vector<bool>& columns, std::int64_t n_particles, const StateLimits& limits)
{
  const Particles<D>& particles = state.particles;
  must(state.stage.number >= 0 && state.stage.number < limits.stages, "stages");
  // a rank without particles does not know the columns
  const bool known = std::find(columns.begin(), columns.end(), true) != columns.end();
  must(!known || filled_columns(particles) == columns || particles.size() == 0, "columns");
  must(n_particles <= limits.particles + state.resampling.splits, "bodies");
  const auto within = [](const auto& column, auto limit) {
    return std::all_of(column.begin(), column.end(), [&](auto value) { return 0 <= value && value < limit; });
  };
  const KnownIds known_ids{limits.particles, state.resampling.splits};
  must(within(particles.cell, limits.cells) && std::ranges::all_of(particles.id, [&](std::int64_t id) { return known_ids.has(id); }),
       "particles");
  must(state.empty_cells.fits(limits.cells), "cells without particles");
}

/// Sets the laws of bodies that change in a stage.
void take_laws_of(const StageState& stage, std::span<const std::vector<Material>> laws, std::vector<Material>& materials)
{
  if (laws.empty())
    return;
  must(stage.number >= 0 && std::cmp_less(stage.number, laws.size()), "stages");
  materials = laws[static_cast<std::size_t>(stage.number)];
}

/// Throws EnvironmentError for an invalid state.
void refuse_if_any(const std::vector<std::string>& faults)
{
  if (!faults.empty())
    throw EnvironmentError(fmt::format("{}", fmt::join(faults, "; ")));
}

}  // namespace

namespace {

/// The results folder of a checkpoint, if it lies in one.
std::optional<fs::path> folder_of_run(const fs::path& checkpoint)
{
  const fs::path place = fs::weakly_canonical(checkpoint).parent_path();
  std::error_code not_there;
  if (place.filename() == checkpoint_folder && fs::exists(place.parent_path() / "summary.json", not_there))
    return place.parent_path();
  return std::nullopt;
}

}  // namespace

CheckpointList::CheckpointList(const fs::path& at)
{
  std::error_code unreadable;
  if (!fs::exists(at, unreadable))
    throw EnvironmentError(fmt::format("{} is not there", at.string()));
  const bool is_run = fs::is_directory(at, unreadable);
  files_ = is_run ? checkpoints_in(at / checkpoint_folder) : std::vector{at};
  if (!is_run)
    folder_ = folder_of_run(at);
  else if (fs::exists(at / "summary.json", unreadable))
    folder_ = at;
  if (files_.empty())
    throw EnvironmentError(fmt::format(
        "{} has no checkpoints: the run is over, or was stopped before one was due; with outputs.checkpoint.at_end it leaves one",
        at.string()));
  std::string reasons;
  for (const fs::path& file : files_) {
    try {
      const ArrayReader arrays(file);
      std::int64_t written_in = 0;
      load(arrays, "format", written_in);
      load(arrays, "run/version", identity_.version);
      if (written_in != checkpoint_format)
        throw EnvironmentError(fmt::format("{} was written by version {} in format {}; this program knows format {}", file.string(),
                                           identity_.version, written_in, checkpoint_format));
      load(arrays, "run", identity_);
      load(arrays, "clock", clock_);
      load(arrays, "stage", stage_);
      return;
    } catch (const EnvironmentError& e) {
      reasons += fmt::format("{}{}", reasons.empty() ? "" : "; ", e.what());
    }
  }
  throw EnvironmentError(reasons);
}

template <class F>
CheckpointList::Read CheckpointList::newest(F&& f) const
{
  std::string reasons;
  for (const fs::path& file : files_) {
    try {
      f(file);
      return {file, reasons};
    } catch (const EnvironmentError& e) {
      reasons += fmt::format("{}{}", reasons.empty() ? "" : "; ", e.what());
    }
  }
  throw EnvironmentError(reasons);
}

namespace {

/// Adds the name of the file to exceptions of check(), unless it is there already.
template <class Check>
void check_in(const fs::path& file, Check&& check)
try {
  check();
} catch (const EnvironmentError& e) {
  const std::string what = e.what();
  throw EnvironmentError(what.find(file.string()) != what.npos ? what : fmt::format("{}: {}", file.string(), what));
}

}  // namespace

template <int D>
fs::path CheckpointList::take_over(State<D>& state, Recorder<D>& recorder, const StateLimits& limits) const
{
  Communicator& ranks = world();
  const auto columns = filled_columns(state.particles);
  const auto read_all = [&](const ArrayReader& arrays) {
    check_count(arrays, "bodies", state.bodies.size(), "bodies");
    check_count(arrays, "walls/wall", state.boundary.conditions().size(), "walls");
    for_each_part(state, [&](const std::string& name, auto& part) {
      using Part = std::decay_t<decltype(part)>;
      if constexpr (!std::is_same_v<Part, std::vector<Body>> && !is_of_particles<Part>)
        load(arrays, name, part);
    });
    take_laws_of(state.stage, limits.laws, state.materials);
    const std::int64_t n = recall_slice(arrays, ranks.rank(), ranks.size(), state.bodies, state.materials, state.particles);
    check_sizes(state, columns, n, limits);
    std::vector<std::string> faults;
    find_invalid(state.clock, faults);
    find_invalid(state.stage, state.clock, faults);
    find_invalid(state.energy, faults);
    find_invalid(state.particles, state.bodies, state.materials, faults);
    refuse_if_any(faults);
    load(arrays, "recorder", recorder);
    if (!state.boundary.fits() ||
        !recorder.fits(state.boundary.conditions().size(), state.bodies.size(), {limits.particles, state.resampling.splits}))
      throw EnvironmentError("the walls, bodies or points of the checkpoint do not fit the scene");
  };
  const auto [from, reasons] = newest([&](const fs::path& file) {
    // Each rank checks its slice; an error on one rank is thrown on all.
    ranks.agree(Communicator::caught([&] { check_in(file, [&] { read_all(ArrayReader(file)); }); }));
    if (const auto twice = ranks.alone() ? std::nullopt : doubled_id(ranks, state.particles.id))
      throw EnvironmentError(fmt::format("{}: there is more than one particle {}", file.string(), *twice));
  });
  if (!reasons.empty() && ranks.is_root())
    fmt::print(stderr, "warning: {}; going on from {}\n", reasons, from.string());
  return from;
}

template <int D>
CheckpointList::Read CheckpointList::read(KeptBodies<D>& saved) const
{
  return newest([&](const fs::path& file) {
    check_in(file, [&] {
      const ArrayReader arrays(file);
      check_count(arrays, "bodies", saved.bodies.size(), "bodies");
      load(arrays, "clock", saved.clock);
      load(arrays, "stage", saved.stage);
      load(arrays, "energy", saved.energy);
      load(arrays, "flow", saved.flow);
      load(arrays, "empty_cells", saved.empty_cells);
      take_laws_of(saved.stage, saved.laws, saved.materials);
      recall_slice(arrays, 0, 1, saved.bodies, saved.materials, saved.particles);
      std::vector<std::string> faults;
      find_invalid(saved.clock, faults);
      find_invalid(saved.energy, faults);
      find_invalid(saved.particles, saved.bodies, saved.materials, faults);
      refuse_if_any(faults);
    });
  });
}

template fs::path CheckpointList::take_over<2>(State<2>&, Recorder<2>&, const StateLimits&) const;
template fs::path CheckpointList::take_over<3>(State<3>&, Recorder<3>&, const StateLimits&) const;
template CheckpointList::Read CheckpointList::read<2>(KeptBodies<2>&) const;
template CheckpointList::Read CheckpointList::read<3>(KeptBodies<3>&) const;

}  // namespace talus
