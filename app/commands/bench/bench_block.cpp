#include "app/commands/bench/bench_block.hpp"

#include <cmath>

#include "materials/law_examples.hpp"
#include "mesh/generate/generate.hpp"
#include "mesh/quadrature.hpp"
#include "solver/stable_step.hpp"

namespace talus {

namespace {

constexpr Real bench_jitter = 0.15;

/// n points of a set that has at least as many: where there is no set of n, each cell in turn takes other points of the next larger set.
template <int D>
class BenchPoints {
 public:
  explicit BenchPoints(int n) : n_(static_cast<std::size_t>(n))
  {
    for (const int count : seeding_counts<D>())
      if (points_.size() < n_)
        points_ = seeding_points<D>(count).value();
  }
  const std::array<Real, D + 1>& operator()(Index cell, std::size_t i) const
  {
    return points_[(static_cast<std::size_t>(cell) * n_ + i) % points_.size()];
  }

 private:
  std::size_t n_;
  std::vector<std::array<Real, D + 1>> points_;
};

/// A swirl about the middle of the unit box that keeps to its sides, and its gradient.
template <int D>
void set_swirling(Real speed, Particles<D>& particles)
{
  for (std::size_t p = 0; p < particles.x.size(); ++p) {
    const Real x = M_PI * particles.x[p][0], y = M_PI * particles.x[p][1];
    Vec<D> v = Vec<D>::Zero();
    v[0] = speed * std::sin(x) * std::cos(y);
    v[1] = -speed * std::cos(x) * std::sin(y);
    particles.v.set(p, v);
    Mat<D> L = Mat<D>::Zero();
    L(0, 0) = M_PI * speed * std::cos(x) * std::cos(y), L(0, 1) = -M_PI * speed * std::sin(x) * std::sin(y);
    L(1, 0) = -L(0, 1), L(1, 1) = -L(0, 0);
    particles.L.set(p, L);
  }
}

template <int D>
Particles<D> bench_particles(const Mesh<D>& mesh, int per_cell, Real density)
{
  Particles<D> p;
  const BenchPoints<D> points(per_cell);
  for (Index cell = 0; cell < mesh.n_cells(); ++cell) {
    const auto corners = mesh.corners(cell);
    for (std::size_t i = 0; i < static_cast<std::size_t>(per_cell); ++i) {
      Vec<D> x = Vec<D>::Zero();
      for (std::size_t a = 0; a <= D; ++a)
        x += points(cell, i)[a] * corners[a];
      p.id.push_back(p.size());
      p.cell.push_back(cell);
      p.x.push_back(x);
      const Real volume = mesh.volume(cell) / per_cell;
      p.volume0.push_back(volume);
      p.mass.push_back(density * volume);
    }
  }
  p.v.assign(p.id.size(), Vec<D>::Zero());
  p.L.assign(p.id.size(), Mat<D>::Zero());
  p.F.assign(p.id.size(), Mat3::Identity());
  p.stress.assign(p.id.size(), Sym3::Zero());
  return p;
}

TransferOptions bench_transfer(const std::string& name)
{
  TransferOptions transfer;
  for (std::size_t i = 0; i < enum_names(Scheme{}).size(); ++i)
    if (enum_names(Scheme{})[i] == name)
      transfer.scheme = static_cast<Scheme>(i);
  return transfer.with_damping(0, false);
}

/// Walls and loads, by what the block is to have besides.
template <int D>
void close_in(const BenchSetting& setting, Real pressure, BenchBlock<D>& block)
{
  Setup<D>& setup = block.setup;
  for (const auto& name : block.mesh.facet_set_names()) {
    const auto facets = block.mesh.facet_set(name).value();
    BoundaryCondition<D> wall{.name = name, .kind = Roller<D>{}};
    if (setting.option == bench_options::friction)
      wall.kind = Friction<D>{0.3};
    if (setting.option == bench_options::traction) {
      auto load = carried_by_particles<D>(block.mesh, facets, setup.state.particles);
      load.pressure = pressure;
      setup.conditions.loads.on_particles.push_back(std::move(load));
    }
    setup.state.boundary.add(wall, block.mesh, facets);
  }
  if (setting.option == bench_options::body_force)
    setup.conditions.loads.of_place.push_back({[](std::span<const Vec<D>> places, Real, std::span<Vec<D>> accelerations) {
                                                 std::ranges::transform(places, accelerations.begin(),
                                                                        [](const Vec<D>& x) { return Vec<D>(-x); });
                                               },
                                               false});
  if (setting.option == bench_options::history) {
    HistoryOutputSpec history;
    history.points.push_back({"middle", std::vector<Real>(D, 0.5), "", {}});
    block.scene.outputs.history = std::move(history);
    setup.state.particles.x0 = setup.state.particles.x;
  }
}

Material bench_material(const std::string& name, Index n)
{
  Material material;
  for_each_type(Laws{}, [&]<class L>() {
    if (L::name == name)
      material = make_material(law_example<L>(), 0, n, name);
  });
  return material;
}

}  // namespace

Index cells_a_side(int dimension, Index particles, int per_cube)
{
  const Real side = std::pow(static_cast<Real>(particles) / per_cube, Real{1} / dimension);
  return std::max<Index>(2, static_cast<Index>(std::lround(side)));
}

template <int D>
BenchBlock<D> bench_block(const BenchSetting& setting, Index particles, int steps)
{
  constexpr int simplices = D == 2 ? 2 : 6;  // of a square or a cube
  std::array<Index, D> cells;
  cells.fill(cells_a_side(D, particles, simplices * setting.per_cell));
  BenchBlock<D> block{.scene = {}, .mesh = Mesh<D>(jittered(box<D>(Vec<D>::Zero(), Vec<D>::Ones(), cells), bench_jitter, 1)), .setup = {}};
  block.scene.kernel = setting.kernel;
  Setup<D>& setup = block.setup;
  const Index n = setting.per_cell * block.mesh.n_cells();
  setup.state.bodies.push_back({"block", 0, n, {}});
  setup.state.materials.push_back(bench_material(setting.law, n));
  Material& material = setup.state.materials.front();
  const Real density = material.law().density();
  setup.state.particles = bench_particles<D>(block.mesh, setting.per_cell, density);
  material.averages_volume = material.law().description().is_isochoric || setting.option == bench_options::f_bar;
  if (setting.option == bench_options::bulk_viscosity)
    material.viscosity = BulkViscosity{};
  const Real wave = material.wave_speed(0, Mat3::Identity());
  const Real pressure = 1e-3 * density * wave * wave;  // strains of the order of 0.1 %
  set_swirling<D>(bench_swirl * wave, setup.state.particles);
  setup.conditions.transfer = bench_transfer(setting.transfer);
  close_in(setting, pressure, block);

  setup.limits.cfl = 1;  // bends to nothing but a state four times as stiff: `longest` decides
  setup.limits.longest = bench_cfl * shortest_crossing(block.mesh, setup.state.materials, setup.state.particles);
  setup.limits.shortest = 0;
  Stage stage;
  stage.name = "run";
  stage.duration = setup.limits.longest * (steps - 0.5);  // the loop halves what is left of the last two
  setup.stages.push_back(stage);
  return block;
}

template BenchBlock<2> bench_block<2>(const BenchSetting&, Index, int);
template BenchBlock<3> bench_block<3>(const BenchSetting&, Index, int);

}  // namespace talus
