// Time of one kernel evaluation and of opening a cell, on boxes jittered by 15 % that lie well inside the caches' reach.
#include <benchmark/benchmark.h>

#include <random>

#include "kernels/kernels.hpp"
#include "mesh/generate/generate.hpp"

namespace talus {
namespace {

constexpr int per_cell = 8;  // particles a cell opened once serves

template <int D>
const Mesh<D>& mesh()
{
  static const Mesh<D> made = [] {
    std::array<Index, D> cells;
    cells.fill(D == 2 ? 40 : 12);
    return Mesh<D>(jittered<D>(box<D>(Vec<D>::Zero(), Vec<D>::Ones(), cells), 0.15, 1));
  }();
  return made;
}

/// Particles at random in every cell whose stencil is that of the interior.
template <class K, int D>
struct Particles {
  std::vector<Index> cell;
  std::vector<Vec<D>> x;
  Real mean_nodes = 0;
};
template <class K, int D>
Particles<K, D> interior_particles(const K& kernel)
{
  Particles<K, D> particles;
  std::mt19937 random(1);
  std::exponential_distribution<Real> share;  // normalised exponentials are uniform on the simplex
  for (Index c = 0; c < mesh<D>().n_cells(); ++c) {
    const auto& vertices = mesh<D>().cell(c);
    if (std::any_of(vertices.begin(), vertices.end(), [](Index v) { return mesh<D>().on_boundary(v); }))
      continue;
    particles.cell.push_back(c);
    particles.mean_nodes += static_cast<Real>(kernel.stencil(mesh<D>(), c).size());
    for (int p = 0; p < per_cell; ++p) {
      Vec<D> x = Vec<D>::Zero();
      Real total = 0;
      for (const Index v : vertices) {
        const Real b = share(random);
        x += b * mesh<D>().node(v);
        total += b;
      }
      particles.x.push_back(x / total);
    }
  }
  particles.mean_nodes /= static_cast<Real>(particles.cell.size());
  return particles;
}

template <class K, int D, bool evaluates>
void run(benchmark::State& state)
{
  const K kernel(mesh<D>());
  const auto particles = interior_particles<K, D>(kernel);
  typename K::Cell cell;
  Weights<D, K::max_nodes> weights;
  for (auto _ : state) {
    for (std::size_t c = 0; c < particles.cell.size(); ++c) {
      kernel.open(mesh<D>(), particles.cell[c], cell);
      benchmark::DoNotOptimize(&cell);
      if constexpr (evaluates) {
        for (std::size_t p = 0; p < per_cell; p += pack_size) {
          const Vec<D>* const at = &particles.x[c * per_cell + p];
          Pack x[D];
          for (int d = 0; d < D; ++d)
            x[d] = Pack{at[0][d], at[1][d], at[2][d], at[3][d]};
          kernel.evaluate(cell, x, pack_size, weights);
          benchmark::DoNotOptimize(&weights);
        }
      }
      benchmark::ClobberMemory();
    }
  }
  const auto items = static_cast<double>(particles.cell.size()) * (evaluates ? per_cell : 1);
  state.counters[evaluates ? "per_particle" : "per_cell"] =
      benchmark::Counter(items, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["nodes"] = particles.mean_nodes;
}

template <int D, class... K>
void add(TypeList<K...>)
{
  const auto name = [](std::string_view kernel, const char* what) { return std::string(kernel) + "/" + std::to_string(D) + "D/" + what; };
  (benchmark::RegisterBenchmark(name(K::name, "open").c_str(), run<K, D, false>)->Unit(benchmark::kMicrosecond), ...);
  (benchmark::RegisterBenchmark(name(K::name, "open_and_evaluate").c_str(), run<K, D, true>)->Unit(benchmark::kMicrosecond), ...);
}

const bool registered = [] {
  add<2>(Kernels<2>{});
  add<3>(Kernels<3>{});
  return true;
}();

}  // namespace
}  // namespace talus
