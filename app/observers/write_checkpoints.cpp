// Writing of checkpoints.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "app/observers/checkpoint_files.hpp"
#include "app/observers/checkpoint_layout.hpp"
#include "app/observers/checkpoints.hpp"
#include "app/observers/rank_slices.hpp"
#include "app/observers/results.hpp"
#include "core/stop_watch.hpp"
#include "io/checkpoint/kept_arrays.hpp"
#include "io/files/manifest.hpp"
#include "io/system/signals.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// The particles and histories of a rank, which have the `rows` of a file with the bodies `in_file`.
template <int D>
std::vector<SharedArray> arrays_of(const Particles<D>& particles, const std::vector<Material>& materials, const std::vector<Body>& bodies,
                                   const std::vector<Body>& in_file, const Slice& rows)
{
  std::vector<SharedArray> arrays;
  share_columns("particles", particles, rows, arrays);
  for (std::size_t b = 0; b < bodies.size(); ++b)
    share_history(history_of(b), materials[b], rows_of_body(in_file[b], bodies[b], rows), arrays);
  return arrays;
}

/// All other content of a checkpoint.  Stress in empty cells is that of all ranks.
template <int D>
KeptArrays rest_of(const State<D>& state, const EmptyCellStress<D>& empty_cells, const std::vector<Body>& in_file,
                   const RunIdentity& identity, const Recorder<D>& recorder)
{
  KeptArrays rest;
  save(rest, "format", checkpoint_format);
  save(rest, "run", identity);
  for_each_part(state, [&](const std::string& name, const auto& part) {
    using Part = std::decay_t<decltype(part)>;
    if constexpr (std::is_same_v<Part, std::vector<Body>>)
      save(rest, name, in_file);
    else if constexpr (std::is_same_v<Part, EmptyCellStress<D>>)
      save(rest, name, empty_cells);
    else if constexpr (!is_of_particles<Part>)
      save(rest, name, part);
  });
  for (std::size_t b = 0; b < in_file.size(); ++b) {
    save(rest, below("laws/name", b), std::string(state.materials[b].law().name()));
    if (const std::string digest = state.materials[b].law().library_digest(); !digest.empty())
      save(rest, below("laws/library", b), digest);
  }
  save(rest, "recorder", recorder);
  return rest;
}

/// Removes all but the newest `keep` checkpoints of a results folder.
void remove_older(const fs::path& folder, int keep)
{
  const auto all = checkpoints_in(folder / checkpoint_folder);
  const auto manifest = Manifest::of(folder);
  std::error_code stays;  // a file that cannot be removed does not end the run
  for (auto i = static_cast<std::size_t>(keep); i < all.size(); ++i)
    if (!manifest || manifest->proves((fs::path(checkpoint_folder) / all[i].filename()).string()))
      fs::remove(all[i], stays);
}

}  // namespace

template <int D>
Checkpoints<D>::Checkpoints(fs::path folder, const CheckpointSpec& spec, RunIdentity identity, std::optional<std::int64_t> until)
    : folder_(std::move(folder)), spec_(spec), identity_(std::move(identity)), until_(until)
{}

template <int D>
bool Checkpoints<D>::due(const Clock& clock) const
{
  const auto passed = [](Real from, Real to, Real every) { return std::floor(to / every) > std::floor(from / every); };
  return (spec_.steps && clock.step / *spec_.steps > at_->step / *spec_.steps) ||
         (spec_.every && passed(at_->time, clock.time, *spec_.every)) ||
         (!pending_ && std::chrono::duration<Real>(Watch::now() - when_).count() >= spec_.wall_time);
}

template <int D>
void Checkpoints<D>::see(const RunView<D>& view, Recorder<D>& recorder, std::string reason)
{
  StopWatch watch;
  if (task_.is_done())  // so that a failure ends the run soon
    finish();
  watch.lap(seconds_);
  if (!at_)
    at_ = view.state.clock;
  if (const std::string signal = StopRequests::received(); !signal.empty())
    reason = "by " + signal;
  else if (reason.empty() && until_ && view.state.clock.step >= *until_)
    reason = "as asked";
  // Signals and clocks differ between ranks, so the ranks agree on the largest of these.
  enum : std::int64_t { go_on, write_one, stop };
  const std::int64_t wish = !reason.empty() ? stop : view.problem.ranks->is_root() && due(view.state.clock) ? write_one : go_on;
  const std::int64_t what = view.problem.ranks->max(wish);
  if (what == go_on)
    return;
  if (what == stop)
    reason = view.problem.ranks->first(reason);
  if (reason.empty())
    return begin(view, recorder);
  write(view, recorder);
  recorder.finish_frame();
  throw Stopped(fmt::format("stopped {} before step {}, t = {:.6g} s; checkpoint {}", reason, view.state.clock.step + 1,
                            view.state.clock.time, last_.file.string()));
}

template <int D>
void Checkpoints<D>::see_end_of_stage(const RunView<D>& view, Recorder<D>& recorder, Index n_stages)
{
  if (view.state.stage.number + 1 != n_stages)
    return;
  if (spec_.at_end)
    return write(view, recorder);
  StopWatch watch;
  finish();
  watch.lap(seconds_);
}

template <int D>
void Checkpoints<D>::write(const RunView<D>& view, Recorder<D>& recorder)
{
  begin(view, recorder);
  StopWatch watch;
  finish();
  watch.lap(seconds_);
}

template <int D>
void Checkpoints<D>::begin(const RunView<D>& view, Recorder<D>& recorder)
{
  StopWatch watch;
  finish();
  const Clock& clock = view.state.clock;
  const fs::path file = folder_ / checkpoint_folder / name_of_checkpoint(clock.step);
  Communicator& ranks = *view.problem.ranks;
  std::function<void()> flush;
  ranks.together([&] {
    require_results(folder_);
    flush = recorder.flush();  // files named in the checkpoint must be on the disk before it
  });
  at_ = clock;
  if (auto copy = ranks.alone() ? view.take_copy() : std::nullopt) {
    struct Kept {
      ParticleCopy<D> copy;
      KeptArrays rest;
    };
    // A shared pointer, because work that can be stored has to be copyable.
    const auto kept = std::make_shared<const Kept>(
        Kept{std::move(*copy), rest_of(view.state, view.state.empty_cells, view.state.bodies, identity_, recorder)});
    task_.start([kept, flush, file, clock, folder = folder_, keep = spec_.keep] {
      flush();
      const auto& [bodies, materials, particles] = kept->copy;
      Communicator alone;  // one_rank() belongs to the main thread
      try {
        write_arrays(alone, file, arrays_of(particles, materials, bodies, bodies, {0, particles.size()}),
                     [&](ArrayWriter& writer) { kept->rest.write_to(writer); });
        remove_older(folder, keep);
      } catch (const EnvironmentError& e) {
        throw EnvironmentError(fmt::format("{} (checkpoint after step {}, t = {:.6g} s)", e.what(), clock.step, clock.time));
      }
    });
  } else {
    view.fetch_particles();
    ranks.together([&] { flush(); });
    const EmptyCellStress<D> empty_cells = view.state.empty_cells.of_all_ranks(ranks, view.problem.subdomain);
    on_slices(view, [&](const State<D>& slice, const std::vector<Body>& in_file, const Slice& rows) {
      const KeptArrays rest = rest_of(slice, empty_cells, in_file, identity_, recorder);
      write_arrays(ranks, file, arrays_of(slice.particles, slice.materials, slice.bodies, in_file, rows),
                   [&](ArrayWriter& writer) { rest.write_to(writer); });
    });
    if (ranks.is_root())
      remove_older(folder_, spec_.keep);
  }
  pending_ = Written{file, clock.step};
  watch.lap(seconds_);
}

template <int D>
void Checkpoints<D>::finish()
{
  if (!pending_)
    return;
  const Written written = *std::exchange(pending_, std::nullopt);
  task_.wait();
  last_ = written;
  when_ = Watch::now();
}

template class Checkpoints<2>;
template class Checkpoints<3>;

}  // namespace talus
