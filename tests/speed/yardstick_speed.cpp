// The yardstick of `talus bench`: the same swirl on a structured grid, in the shortest loop known, written with care.  MLS-MPM (Hu et al. 2018,
// ACM Trans. Graph. 37, 150) with quadratic B-splines, affine velocities (Jiang et al. 2015) and neo-Hookean rubber in double precision.  It
// knows squares and cubes, one material and walls along the sides, and keeps no accounts.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "core/parallel/threads.hpp"
#include "core/simd.hpp"
#include "core/tensor.hpp"

namespace talus {
namespace {

constexpr std::array phase_names{"locate", "scatter", "nodes", "gather"};
using Phases = std::array<Real, phase_names.size()>;  ///< s

/// All that a step reads and writes of a particle lies together: particles are sorted by node, so that they come and go in order.
template <int D>
struct GridParticle {
  Vec<D> x, v;
  Mat<D> C;  ///< affine field [1/s]
  Mat<D> F;  ///< plane strain in 2-D
  Real volume0, mass;
};

/// Of a particle: the first node of its stencil, and weights and distances along each axis.
template <int D>
struct Stencil {
  std::array<Index, D> first;
  Real weight[D][3], distance[D][3];
};

template <int D>
class GridMpm {
 public:
  GridMpm();
  void step(Phases& seconds);
  bool sound() const noexcept
  {
    return std::all_of(particles_.begin(), particles_.end(), [](const auto& p) { return p.F.determinant() > 0 && p.v.allFinite(); });
  }
  Index size() const noexcept { return static_cast<Index>(particles_.size()); }
  Real bytes_moved() const noexcept
  {
    constexpr Real constants = 2 * sizeof(Real), nodes = 2 * sizeof(Pack);
    return 2 * sizeof(GridParticle<D>) - constants + nodes * static_cast<Real>(grid_.size()) / size();
  }

 private:
  static constexpr Real young = 1e5, poisson = 0.3, density = 1000;
  static constexpr Real cfl = 0.4, swirl = 0.08;  ///< those of `talus bench`; the second over the wave speed
  static constexpr int momentum_lanes = 3;        // lanes of a node: momentum or velocity, and mass in the last
  /// Between two sorts no particle may move by more than a cell: at the speed of the swirl that takes 30 steps.
  static constexpr int steps_between_sorts = 5;
  /// Particles of a slab reach the nodes from one plane before it to three behind: even slabs never meet, nor do odd ones.
  static constexpr Index slab = 4;

  Stencil<D> stencil_of(const Vec<D>& x) const noexcept;
  std::size_t node_of(const std::array<Index, D>& at) const noexcept
  {
    std::size_t node = 0;
    for (const Index i : at)
      node = node * static_cast<std::size_t>(n_ + 3) + static_cast<std::size_t>(i);
    return node;
  }
  void sort();
  void scatter();
  void scatter(const GridParticle<D>& p);
  void move_nodes();
  void gather();
  void gather(GridParticle<D>& p) const;

  Index n_;  // cells along a side; nodes begin one before it
  Real h_, dt_;
  Lame lame_ = lame(young, poisson);
  std::vector<GridParticle<D>> particles_, sorted_;
  std::vector<Index> begin_of_node_, slab_begin_;
  std::vector<Pack> grid_;
  int steps_ = 0;
};

template <int D>
GridMpm<D>::GridMpm() : n_(D == 2 ? 500 : 50), h_(Real{1} / n_)  // a million particles
{
  constexpr Index along = 2;  // particles along a side of a cell
  const Real wave = std::sqrt((lame_.lambda + 2 * lame_.mu) / density);
  dt_ = cfl * h_ / ((1 + swirl) * wave);
  const Index rows = along * n_;
  const Index count = D == 2 ? rows * rows : rows * rows * rows;
  const Real spacing = h_ / along;
  for (Index i = 0; i < count; ++i) {
    GridParticle<D> p;
    Index rest = i;
    for (int d = D - 1; d >= 0; --d) {
      p.x[d] = spacing * (rest % rows + Real{0.5} + 0.3 * std::sin(Real{7} * i + d));  // off the lattice, as seeds in simplices are
      rest /= rows;
    }
    const Real x = M_PI * p.x[0], y = M_PI * p.x[1], speed = swirl * wave;
    p.v.setZero();
    p.v[0] = speed * std::sin(x) * std::cos(y);
    p.v[1] = -speed * std::cos(x) * std::sin(y);
    p.C.setZero();
    p.C(0, 0) = M_PI * speed * std::cos(x) * std::cos(y), p.C(0, 1) = -M_PI * speed * std::sin(x) * std::sin(y);
    p.C(1, 0) = -p.C(0, 1), p.C(1, 1) = -p.C(0, 0);
    p.F.setIdentity();
    p.volume0 = std::pow(spacing, D);
    p.mass = density * p.volume0;
    particles_.push_back(p);
  }
  sorted_.resize(particles_.size());
  std::array<Index, D> last;
  last.fill(n_ + 2);
  grid_.assign(node_of(last) + 1, Pack{});
  begin_of_node_.resize(grid_.size() + 1);
}

template <int D>
Stencil<D> GridMpm<D>::stencil_of(const Vec<D>& x) const noexcept
{
  Stencil<D> s;
  for (int d = 0; d < D; ++d) {
    const Real place = x[d] * n_ + 1;
    const Index first = static_cast<Index>(place - 0.5);
    const Real u = place - first;  // in [0.5, 1.5]
    s.first[static_cast<std::size_t>(d)] = first;
    s.weight[d][0] = 0.5 * (1.5 - u) * (1.5 - u);
    s.weight[d][1] = 0.75 - (u - 1) * (u - 1);
    s.weight[d][2] = 0.5 * (u - 0.5) * (u - 0.5);
    for (int i = 0; i < 3; ++i)
      s.distance[d][i] = (i - u) * h_;
  }
  return s;
}

/// Counting sort by the first node.
template <int D>
void GridMpm<D>::sort()
{
  std::fill(begin_of_node_.begin(), begin_of_node_.end(), 0);
  const auto key = [&](const GridParticle<D>& p) {
    std::array<Index, D> first;
    for (int d = 0; d < D; ++d)
      first[static_cast<std::size_t>(d)] = static_cast<Index>(std::lround(p.x[d] * n_));
    return node_of(first);
  };
  for (const auto& p : particles_)
    ++begin_of_node_[key(p) + 1];
  for (std::size_t i = 1; i < begin_of_node_.size(); ++i)
    begin_of_node_[i] += begin_of_node_[i - 1];
  slab_begin_.clear();
  for (Index plane = 0; plane < n_ + 3; plane += slab) {
    std::array<Index, D> first{};
    first[0] = plane;
    slab_begin_.push_back(begin_of_node_[node_of(first)]);
  }
  slab_begin_.push_back(size());
  for (const auto& p : particles_)
    sorted_[static_cast<std::size_t>(begin_of_node_[key(p)]++)] = p;
  particles_.swap(sorted_);
}

template <int D>
void GridMpm<D>::scatter()
{
  const auto planes = static_cast<std::size_t>(n_ + 3), of_plane = grid_.size() / planes;
  parallel_for(n_ + 3, [&](Index plane) {
    std::fill_n(grid_.begin() + static_cast<std::ptrdiff_t>(plane) * static_cast<std::ptrdiff_t>(of_plane), of_plane, Pack{});
  });
  const auto slabs = static_cast<Index>(slab_begin_.size()) - 1;
  for (Index colour = 0; colour < 2; ++colour)
    parallel_for_uneven((slabs - colour + 1) / 2, [&](Index i) {
      const auto s = static_cast<std::size_t>(2 * i + colour);
      for (Index p = slab_begin_[s]; p < slab_begin_[s + 1]; ++p)
        scatter(particles_[static_cast<std::size_t>(p)]);
    });
}

/// Momentum, mass and the impulse of stress go to a node in one: w (m v + (m C - 4 dt V0 tau / h^2) (x_i - x_p)), tau that of Kirchhoff.
template <int D>
void GridMpm<D>::scatter(const GridParticle<D>& p)
{
  const Stencil<D> s = stencil_of(p.x);
  const Real pressure = lame_.lambda * std::log(p.F.determinant()) - lame_.mu;
  const Mat<D> tau = lame_.mu * (p.F * p.F.transpose()) + pressure * Mat<D>::Identity();
  const Mat<D> affine = p.mass * p.C - (4 * dt_ * p.volume0 / (h_ * h_)) * tau;
  Pack slope[D], value{};
  for (int d = 0; d < D; ++d) {
    value[d] = p.mass * p.v[d];
    slope[d] = Pack{};
    for (int e = 0; e < D; ++e)
      slope[d][e] = affine(e, d);
  }
  value[momentum_lanes] = p.mass;

  Pack* const first = &grid_[node_of(s.first)];
  const auto row = static_cast<std::size_t>(n_ + 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const Pack of_plane = value + slope[0] * s.distance[0][i];
    if constexpr (D == 2) {
      for (std::size_t j = 0; j < 3; ++j)
        first[i * row + j] += (s.weight[0][i] * s.weight[1][j]) * (of_plane + slope[1] * s.distance[1][j]);
    } else {
      for (std::size_t j = 0; j < 3; ++j) {
        const Pack of_line = of_plane + slope[1] * s.distance[1][j];
        const Real weight = s.weight[0][i] * s.weight[1][j];
        for (std::size_t k = 0; k < 3; ++k)
          first[(i * row + j) * row + k] += (weight * s.weight[2][k]) * (of_line + slope[2] * s.distance[2][k]);
      }
    }
  }
}

/// Momentum -> velocity; nothing passes the sides of the box.
template <int D>
void GridMpm<D>::move_nodes()
{
  const Index nodes = n_ + 3, low = 1, high = n_ + 1;
  const Index lines = static_cast<Index>(grid_.size()) / nodes;
  parallel_for(lines, [&](Index line) {
    for (Index last = 0; last < nodes; ++last) {
      Pack& node = grid_[static_cast<std::size_t>(line) * static_cast<std::size_t>(nodes) + static_cast<std::size_t>(last)];
      const Real mass = node[momentum_lanes];
      if (!(mass > 0))
        continue;
      node *= 1 / mass;
      Index rest = line;
      if (last <= low || last >= high)
        node[D - 1] = 0;
      for (int d = D - 2; d >= 0; --d) {
        if (rest % nodes <= low || rest % nodes >= high)
          node[d] = 0;
        rest /= nodes;
      }
    }
  });
}

template <int D>
void GridMpm<D>::gather()
{
  parallel_for(size(), [&](Index p) { gather(particles_[static_cast<std::size_t>(p)]); });
}

/// v = sum of w v_i, C = 4 / h^2 times the sum of w v_i (x_i - x_p)^T.
template <int D>
void GridMpm<D>::gather(GridParticle<D>& p) const
{
  const Stencil<D> s = stencil_of(p.x);
  Pack value{}, slope[D];
  for (Pack& column : slope)
    column = Pack{};
  const Pack* const first = &grid_[node_of(s.first)];
  const auto row = static_cast<std::size_t>(n_ + 3);
  for (std::size_t i = 0; i < 3; ++i) {
    Pack of_plane{};
    for (std::size_t j = 0; j < 3; ++j) {
      if constexpr (D == 2) {
        const Pack v = s.weight[1][j] * first[i * row + j];
        of_plane += v;
        slope[1] += (s.weight[0][i] * s.distance[1][j]) * v;
      } else {
        Pack of_line{}, along_line{};
        for (std::size_t k = 0; k < 3; ++k) {
          const Pack v = s.weight[2][k] * first[(i * row + j) * row + k];
          of_line += v;
          along_line += s.distance[2][k] * v;
        }
        const Real weight = s.weight[0][i] * s.weight[1][j];
        of_plane += s.weight[1][j] * of_line;
        slope[1] += (weight * s.distance[1][j]) * of_line;
        slope[2] += weight * along_line;
      }
    }
    value += s.weight[0][i] * of_plane;
    slope[0] += (s.weight[0][i] * s.distance[0][i]) * of_plane;
  }
  for (int d = 0; d < D; ++d) {
    p.v[d] = value[d];
    for (int e = 0; e < D; ++e)
      p.C(e, d) = 4 / (h_ * h_) * slope[d][e];
  }
  for (int d = 0; d < D; ++d)
    p.x[d] = std::clamp(p.x[d] + dt_ * p.v[d], Real{0}, Real{1});
  p.F += dt_ * (p.C * p.F).eval();
}

template <int D>
void GridMpm<D>::step(Phases& seconds)
{
  const auto timed = [](Real& phase, auto&& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    phase += std::chrono::duration<Real>(std::chrono::steady_clock::now() - begin).count();
  };
  timed(seconds[0], [&] {
    if (steps_++ % steps_between_sorts == 0)
      sort();
  });
  timed(seconds[1], [&] { scatter(); });
  timed(seconds[2], [&] { move_nodes(); });
  timed(seconds[3], [&] { gather(); });
}

template <int D>
void yardstick(benchmark::State& state, int n_threads)
{
  constexpr int warm_up = 10;
  set_threads(n_threads);
  GridMpm<D> grid;
  Phases seconds{};
  for (int i = 0; i < warm_up; ++i)
    grid.step(seconds);
  seconds = {};
  for (auto _ : state)
    grid.step(seconds);
  if (!grid.sound())
    state.SkipWithError("the state is no longer sound");
  const Real particle_steps = static_cast<Real>(state.iterations()) * static_cast<Real>(grid.size());
  state.SetItemsProcessed(state.iterations() * grid.size());
  state.counters["bytes moved"] = grid.bytes_moved();
  for (std::size_t i = 0; i < seconds.size(); ++i)
    state.counters[fmt::format("{} [ns]", phase_names[i])] = 1e9 * seconds[i] / particle_steps;
}

const bool registered = [] {
  for (const int n_threads : {1, 2}) {
    benchmark::RegisterBenchmark(fmt::format("yardstick/3-D/threads:{}", n_threads).c_str(), yardstick<3>, n_threads)->UseRealTime();
    benchmark::RegisterBenchmark(fmt::format("yardstick/2-D/threads:{}", n_threads).c_str(), yardstick<2>, n_threads)->UseRealTime();
  }
  return true;
}();

}  // namespace
}  // namespace talus
