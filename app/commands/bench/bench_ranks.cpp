#include "app/commands/bench/bench_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <thread>

#include "app/commands/bench/bench_measure.hpp"
#include "app/setup/seed.hpp"
#include "core/parallel/communicator.hpp"
#include "core/parallel/threads.hpp"
#include "core/version.hpp"
#include "io/output/bench_json.hpp"

namespace talus {

namespace {

/// What stands in a row of each rank, before the times.
constexpr std::array rank_columns{
    "particles",        "cells",           "cells_held",          "nodes",           "nodes_shared",   "messages", "bytes", "collectives",
    "collective_bytes", "particles_moved", "particle_memory [B]", "mesh_memory [B]", "node_memory [B]"};

struct RankMark {
  std::chrono::steady_clock::time_point time;
  std::clock_t cpu;
  Laps::Totals phases;
  Traffic traffic;
  std::int64_t moved;
};

/// Seconds of a step between two marks: the phases, the rest, all of it, processor time of all threads.
std::vector<Real> seconds_between(const RankMark& from, const RankMark& to, int steps)
{
  std::vector<Real> seconds;
  const Real whole = std::chrono::duration<Real>(to.time - from.time).count() / steps;
  Real rest = whole;
  for (std::size_t k = 0; k < from.phases.size(); ++k) {
    seconds.push_back((to.phases[k].second - from.phases[k].second) / steps);
    rest -= seconds.back();
  }
  seconds.insert(seconds.end(), {rest, whole, static_cast<Real>(to.cpu - from.cpu) / CLOCKS_PER_SEC / steps});
  return seconds;
}

/// Of this rank, in the order of rank_columns.
template <int D>
std::vector<Real> holdings(const RunView<D>& view, const RankMark& from, const RankMark& to, int steps, const Estimate& memory)
{
  const bool alone = view.problem.subdomain.alone();
  const auto owns_cell = [&](Index c) { return alone || view.problem.subdomain.owns_cell(c); };
  Index cells = 0, nodes = 0, shared = 0;
  for (Index c = 0; c < view.problem.mesh.n_cells(); ++c)
    cells += owns_cell(c) ? 1 : 0;
  for (Index n = 0; n < view.problem.mesh.n_nodes(); ++n) {
    nodes += alone || view.problem.subdomain.owns_node(n) ? 1 : 0;
    const auto around = view.problem.mesh.cells_of_node()[n];
    shared += std::any_of(around.begin(), around.end(), owns_cell) && !std::all_of(around.begin(), around.end(), owns_cell) ? 1 : 0;
  }
  const auto a_step = [&](std::int64_t before, std::int64_t now) { return static_cast<Real>(now - before) / steps; };
  const Traffic &before = from.traffic, &now = to.traffic;
  return {static_cast<Real>(n_particles(view)),
          static_cast<Real>(cells),
          static_cast<Real>(view.problem.mesh.n_cells()),
          static_cast<Real>(nodes),
          static_cast<Real>(shared),
          a_step(before.messages, now.messages),
          a_step(before.bytes, now.bytes),
          a_step(before.calls, now.calls),
          a_step(before.bytes_to_all, now.bytes_to_all),
          a_step(from.moved, to.moved),
          static_cast<Real>(memory.particle_bytes),
          static_cast<Real>(memory.mesh_bytes),
          static_cast<Real>(memory.node_bytes)};
}

/// Rows of numbers of all ranks on the root: columns, and times of the repeat whose slowest rank takes the median time.
void add_rows(const std::vector<std::vector<Real>>& held, const std::vector<std::vector<Real>>& times, std::size_t n_times,
              RanksReport& report)
{
  const std::size_t repeats = times.front().size() / n_times, whole = n_times - 2;
  std::vector<std::pair<Real, std::size_t>> slowest;
  for (std::size_t r = 0; r < repeats; ++r) {
    Real most = 0;
    for (const std::vector<Real>& of_rank : times)
      most = std::max(most, of_rank[r * n_times + whole]);
    slowest.emplace_back(most, r);
  }
  std::vector<Real> values;
  for (const auto& entry : slowest)
    values.push_back(entry.first);
  report.seconds = measured(values);
  std::sort(slowest.begin(), slowest.end());
  const std::size_t median = slowest[(repeats - 1) / 2].second;
  for (std::size_t q = 0; q < held.size(); ++q) {
    std::vector<Real> row = held[q];
    const auto first = times[q].begin() + static_cast<std::ptrdiff_t>(median * n_times);
    row.insert(row.end(), first, first + static_cast<std::ptrdiff_t>(n_times));
    report.ranks.push_back(std::move(row));
  }
}

/// Particles in the cells that this rank fills of a scene: ranks set a run up by parts.
template <int D>
void keep_part(const Mesh<D>& mesh, Setup<D>& setup)
{
  const IndexRange filled = cells_to_fill(mesh, world());
  setup.n_particles = setup.state.particles.size();
  for (Index& cell : setup.state.particles.cell)
    if (cell < filled.begin || cell >= filled.end)
      cell = none;
  drop_lost(setup.state.bodies, setup.state.materials, setup.state.particles);
}

template <int D>
void measure_ranks(const BenchSetting& setting, const BenchPlan& plan, RanksReport& report)
{
  auto block = bench_block<D>(setting, plan.particles, plan.all_steps());
  report.particles = block.setup.state.particles.size();
  keep_part(block.mesh, block.setup);
  report.cells = block.mesh.n_cells(), report.nodes = block.mesh.n_nodes();
  const Estimate memory = estimate<D>(block.scene, block.mesh, block.setup);  // of the part of this rank
  std::vector<RankMark> marks;
  std::vector<Real> held, times;
  std::size_t n_times = 0;
  int done = 0;
  simulate<D>(block.scene, std::move(block.mesh), std::move(block.setup),
              {[&](const RunView<D>& view, RunEvent event) {
                 if (event != RunEvent::step_done)
                   return;
                 ++done;
                 if (done >= plan.warm_up && (done - plan.warm_up) % plan.steps == 0)
                   marks.push_back({std::chrono::steady_clock::now(), std::clock(), phases_of(view.state.timings),
                                    view.problem.ranks->traffic(), view.migrated});
                 if (done == plan.all_steps())
                   held = holdings(view, marks.front(), marks.back(), plan.repeats * plan.steps, memory);
               },
               [](const RunView<D>&, const StageResult&) {}});
  for (std::size_t i = 1; i < marks.size(); ++i) {
    const std::vector<Real> seconds = seconds_between(marks[i - 1], marks[i], plan.steps);
    n_times = seconds.size();
    times.insert(times.end(), seconds.begin(), seconds.end());
  }
  report.columns.assign(rank_columns.begin(), rank_columns.end());
  for (const auto& phase : marks.front().phases)
    report.columns.push_back(fmt::format("{} [s]", phase.first));
  report.columns.insert(report.columns.end(), {"rest [s]", "step [s]", "cpu [s]"});
  const auto all_held = gather_rows<Real>(world(), held), all_times = gather_rows<Real>(world(), times);
  if (world().is_root())
    add_rows(all_held, all_times, n_times, report);
}

std::string ranks_table(const RanksReport& report)
{
  constexpr Real milli = 1e3, kilo_bytes = 1e-3, mega_bytes = 1e-6;
  const auto number = [&](std::size_t rank, std::string_view name) {
    const auto at = std::find(report.columns.begin(), report.columns.end(), name);
    return report.ranks[rank][static_cast<std::size_t>(at - report.columns.begin())];
  };
  const std::size_t n = report.ranks.size();
  const auto row = [&](const std::string& name, auto&& of) {
    const Real cells = of("cells"), nodes = of("nodes");
    std::string line =
        fmt::format("{:>6}{:>11.0f}{:>10.0f}{:>10.2f}{:>12.3f}{:>8.1f}{:>11.1f}{:>7.1f}{:>9.2f}{:>8.1f}", name, of("particles"), cells,
                    cells > 0 ? of("cells_held") / cells : 0, nodes > 0 ? of("nodes_shared") / nodes : 0, of("messages"),
                    kilo_bytes * of("bytes"), of("collectives"), kilo_bytes * of("collective_bytes"),
                    mega_bytes * (of("particle_memory [B]") + of("mesh_memory [B]") + of("node_memory [B]")));
    for (std::size_t c = rank_columns.size(); c < report.columns.size(); ++c)
      line += fmt::format("{:>9.2f}", milli * of(report.columns[c]));
    return line + '\n';
  };
  std::string text = fmt::format("{:>6}{:>11}{:>10}{:>10}{:>12}{:>8}{:>11}{:>7}{:>9}{:>8}", "rank", "particles", "cells", "held/own",
                                 "shared/own", "mess.", "kB sent", "coll.", "kB coll.", "MB");
  for (std::size_t c = rank_columns.size(); c < report.columns.size(); ++c)
    text += fmt::format("{:>9}", std::string_view(report.columns[c]).substr(0, report.columns[c].find(" [")));
  text += '\n';
  constexpr std::size_t most_shown = 32;
  for (std::size_t q = 0; q < std::min(n, most_shown); ++q)
    text += row(std::to_string(q), [&](std::string_view name) { return number(q, name); });
  if (n > most_shown)
    text += fmt::format("   ... and {} more\n", n - most_shown);
  Real most_particles = 0, moved = 0;
  std::vector<Real> most(report.columns.size(), 0);
  for (std::size_t q = 0; q < n; ++q) {
    most_particles = std::max(most_particles, number(q, "particles"));
    moved += number(q, "particles_moved") / 2;  // counted where they leave and where they come
    for (std::size_t c = 0; c < most.size(); ++c)
      most[c] = std::max(most[c], report.ranks[q][c]);
  }
  const auto particles = static_cast<Real>(report.particles);
  text += "most, of any rank: ";
  for (std::size_t c = rank_columns.size(); c < report.columns.size(); ++c)
    text += fmt::format("{}{} {:.2f} ms", c == rank_columns.size() ? "" : ", ", report.columns[c].substr(0, report.columns[c].find(" [")),
                        milli * most[c]);
  text += fmt::format("\nimbalance {:.3f}: particles of the busiest rank over the mean; {:.2g} of all particles change rank in a step\n",
                      most_particles * static_cast<Real>(n) / particles, moved / particles);
  return text +
         fmt::format("step {:.2f} ms ({:.2f} to {:.2f}), {:.3f} million particle-steps per second\n", milli * report.seconds.median,
                     milli * report.seconds.least, milli * report.seconds.most, 1e-6 * particles / report.seconds.median) +
         "held: cells held over own; shared: nodes of own cells that cells of other ranks use too, over own nodes; mess., kB sent: to "
         "single ranks in a\n"
         "step; coll.: sums and minima over all ranks in a step; MB: particles, mesh and nodes; then ms of a step by phase, waiting for "
         "others included\n";
}

}  // namespace

void bench_ranks(const BenchOptions& options)
{
  const BenchSetting setting = one_setting(options);
  const BenchPlan plan{options.particles, options.warm_up, options.repeats, options.steps};
  const Version v = version();
  RanksReport report{.version = std::string(v.number),
                     .commit = std::string(v.commit),
                     .compiler = std::string(v.compiler),
                     .build = build_of(v),
                     .processor = processor_name(),
                     .cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency())),
                     .setting = setting,
                     .steps = options.steps,
                     .seconds = {},
                     .columns = {},
                     .ranks = {}};
  set_threads(setting.threads);
  if (setting.dimension == 2)
    measure_ranks<2>(setting, plan, report);
  else
    measure_ranks<3>(setting, plan, report);
  world().together([&] {
    fmt::print("talus {} ({}), {}; {}\n{}: {} particles, {} cells on {} rank{}\n{}", report.version, report.commit, report.build,
               report.processor, describe(setting), report.particles, report.cells, report.ranks.size(),
               report.ranks.size() == 1 ? "" : "s", ranks_table(report));
    if (options.json)
      write_ranks(*options.json, report);
  });
}

}  // namespace talus
