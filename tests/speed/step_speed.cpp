// Particle-steps per second of the whole step: a jittered box of 20^3 x 6 tetrahedra with 8 particles each and rollers all around.
#include <benchmark/benchmark.h>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing {
namespace {

constexpr Index cells_a_side = 20;
constexpr int per_cell = 8;

/// Rubber that swirls about the middle.
template <class K>
Model<3> swirl(const TransferOptions& transfer)
{
  auto m = make_model<K>(unit_box<3>(cells_a_side, 0.15));
  m.problem.transfer = transfer;
  add_body<3>(
      m, "block", rubber(1e5, 0.3, 1000), per_cell, [](const Vec3&) { return true; },
      [](const Vec3& x) { return Vec3(std::sin(M_PI * x[0]) * std::cos(M_PI * x[1]), -std::cos(M_PI * x[0]) * std::sin(M_PI * x[1]), 0); });
  for (const auto& name : m.problem.mesh.facet_set_names()) {
    m.state.boundary.add({.name = name, .kind = Roller<3>{}}, m.problem.mesh, *m.problem.mesh.facet_set(name));
  }
  make_ready(m);
  return m;
}

template <class K>
void steps(benchmark::State& state, const TransferOptions& transfer, int n_threads)
{
  set_threads(n_threads);
  auto m = swirl<K>(transfer);
  const Real dt = 0.4 * shortest_crossing(m.problem.mesh, m.state.materials, m.state.particles);
  advance(m, dt);  // sorts the particles and sizes all buffers
  for (auto _ : state)
    advance(m, dt);
  if (m.work.errors.worst())
    state.SkipWithError("the state is no longer sound");
  state.SetItemsProcessed(state.iterations() * m.state.particles.size());
}

template <class K>
void add()
{
  const std::pair<const char*, TransferOptions> transfers[] = {
      {"tpic", {.scheme = Scheme::tpic, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}}},
      {"flip", {.scheme = Scheme::flip, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}}},
      {"aflip_musl", {.scheme = Scheme::aflip, .musl = true, .pic_damping_time = {}, .pic_damping_crossings = 25}},
      {"flip_musl", {.scheme = Scheme::flip, .musl = true, .pic_damping_time = {}, .pic_damping_crossings = {}}}};
  for (const auto& [name, transfer] : transfers)
    for (const int n_threads : {1, 2})
      benchmark::RegisterBenchmark(fmt::format("step/{}/{}/threads:{}", K::name, name, n_threads).c_str(), steps<K>, transfer, n_threads)
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
}

const bool registered = [] {
  for_each_type(Kernels<3>{}, []<class K>() { add<K>(); });
  return true;
}();

}  // namespace
}  // namespace talus::testing
