#include "app/seed.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "app/expression.hpp"
#include "core/parallel.hpp"
#include "io/memory.hpp"
#include "mesh/quadrature.hpp"

namespace talus {

namespace {

/// Fills one body after the other.
template <int D>
class Seeder {
 public:
  Seeder(const Scene& scene, const Mesh<D>& mesh, Complaints& complaints) : scene_(scene), mesh_(mesh), complaints_(complaints)
  {
    seeds_.particles.keep_in(scene.precision);  // while they are none: never more memory than the run needs
  }

  void add(const BodySpec& spec)
  {
    const auto points = seeding_points<D>(spec.particles_per_cell.value());
    if (!points)
      complain_of_count(spec);
    const auto cells = cells_of(spec);
    const MaterialSpec* material = material_of(spec);
    if (!points || !cells || material == nullptr)
      return;
    const Index begin = seeds_.particles.size();
    const Real density = std::visit([](const auto& law) { return law.density; }, material->law);
    const std::vector<std::int64_t> first = count(*cells, *points, spec);
    if (const std::string why = too_many_particles(first.back(), material->law); !why.empty())
      return complaints_.add(spec.where, "particles_per_cell", why);
    fill(*cells, *points, spec, density, first);
    const Index end = seeds_.particles.size();
    if (begin == end)
      complaints_.add(spec.where, "",
                      fmt::format("the body has no particles: {}",
                                  spec.shape ? "its shape contains no particle centre of the mesh" : "its group has no cells"));
    seeds_.bodies.push_back({spec.name, begin, end, spec.where});
    AnyBatch batch =
        std::visit([&](const auto& law) { return make_any_batch(law, begin, end, material->name, material->where); }, material->law);
    std::visit(
        [&]<class L>(Batch<L>& typed) {
          typed.viscosity = material->bulk_viscosity;
          typed.averages_volume = spec.f_bar.value_or(is_isochoric<L>());
        },
        batch);
    seeds_.materials.push_back(std::move(batch));
    set_velocity(spec, begin, end);
  }

  Seeds<D> take() { return std::move(seeds_); }

 private:
  void complain_of_count(const BodySpec& spec)
  {
    std::vector<std::string> known;
    for (const int n : seeding_counts<D>())
      known.push_back(std::to_string(n));
    complaints_.add(spec.where, "particles_per_cell",
                    fmt::format("there is no symmetric set of {} points in a {}; there is {}", spec.particles_per_cell.value(),
                                D == 2 ? "triangle" : "tetrahedron", or_list(known)));
  }

  std::optional<std::vector<Index>> cells_of(const BodySpec& spec)
  {
    if (spec.shape) {
      std::vector<Index> all(static_cast<std::size_t>(mesh_.n_cells()));
      for (std::size_t c = 0; c < all.size(); ++c)
        all[c] = static_cast<Index>(c);
      return all;
    }
    auto cells = mesh_.cell_set(spec.region);
    if (!cells)
      complaints_.unknown_group(spec.where, "region", "cell", spec.region, mesh_.cell_set_names());
    return cells;
  }

  const MaterialSpec* material_of(const BodySpec& spec) const
  {
    const auto found =
        std::find_if(scene_.materials.begin(), scene_.materials.end(), [&](const MaterialSpec& m) { return m.name == spec.material; });
    return found == scene_.materials.end() ? nullptr : &*found;  // the reader has complained
  }

  /// f(x) for the particles of a cell that lie in the shape.
  template <class F>
  void for_each_place(Index cell, const std::vector<std::array<Real, D + 1>>& points, const BodySpec& spec, F&& f) const
  {
    const auto corners = mesh_.corners(cell);
    for (const auto& point : points) {
      Vec<D> x = Vec<D>::Zero();
      for (std::size_t a = 0; a <= D; ++a)
        x += point[a] * corners[a];
      if (!spec.shape || contains(*spec.shape, std::span<const Real>(x.data(), D)))
        f(x);
    }
  }

  /// Row of the first particle of each cell, behind those there are, and of what comes then.
  std::vector<std::int64_t> count(const std::vector<Index>& cells, const std::vector<std::array<Real, D + 1>>& points,
                                  const BodySpec& spec) const
  {
    std::vector<std::int64_t> first(cells.size() + 1, 0);
    parallel_for(static_cast<Index>(cells.size()),
                 [&](Index i) { for_each_place(cells[i], points, spec, [&](const Vec<D>&) { ++first[i + 1]; }); });
    first[0] = seeds_.particles.size();
    std::partial_sum(first.begin(), first.end(), first.begin());
    return first;
  }

  /// Columns that every particle has.
  template <class F>
  static void with_columns(Particles<D>& p, F&& f)
  {
    f(p.id, p.cell, p.x, p.v, p.L, p.F, p.stress, p.volume0, p.mass);
  }

  /// Why there cannot be so many, with those of bodies before; empty if they can.
  std::string too_many_particles(std::int64_t all, const AnyLaw& law) const
  {
    if (all > std::numeric_limits<Index>::max())
      return fmt::format("{} particles are more than can be numbered", all);
    Particles<D> one;
    one.keep_in(scene_.precision);
    with_columns(one, [](auto&... columns) { (columns.resize(1), ...); });
    std::size_t bytes = std::visit([]<class L>(const L&) { return sizeof(typename L::State); }, law);
    one.for_each_column([&](std::string_view, std::string_view, const auto& column) { bytes += column.size() * sizeof(column[0]); });
    return too_many(static_cast<Real>(all - seeds_.particles.size()), "particles", static_cast<Real>(bytes));
  }

  /// Rows for the particles of cells.
  void fill(const std::vector<Index>& cells, const std::vector<std::array<Real, D + 1>>& points, const BodySpec& spec, Real density,
            const std::vector<std::int64_t>& first)
  {
    Particles<D>& p = seeds_.particles;
    const auto all = static_cast<std::size_t>(first.back());
    with_columns(p, [&](auto&... columns) { (columns.resize(all), ...); });
    parallel_for(static_cast<Index>(cells.size()), [&](Index i) {
      const Index cell = cells[i];
      const Real volume = mesh_.volume(cell) / static_cast<Real>(points.size());
      auto row = static_cast<std::size_t>(first[i]);
      for_each_place(cell, points, spec, [&](const Vec<D>& x) {
        p.id[row] = static_cast<std::int64_t>(row);
        p.cell[row] = cell;
        p.x[row] = x;
        p.v.set(row, Vec<D>::Zero());
        p.L.set(row, Mat<D>::Zero());
        p.F.set(row, Mat3::Identity());
        p.stress.set(row, Sym3::Zero());
        p.volume0[row] = volume;
        p.mass.set(row, density * volume);
        ++row;
      });
    });
  }

  /// Velocity and its gradient: without the latter, affine schemes would begin with particles that do not turn.
  void set_velocity(const BodySpec& spec, Index begin, Index end)
  {
    if (spec.velocity.empty())
      return;
    Particles<D>& particles = seeds_.particles;
    const auto first = static_cast<std::size_t>(begin), count = static_cast<std::size_t>(end - begin);
    std::vector<Vec3> places(count, Vec3::Zero());
    std::vector<Real> sizes(count);  // of cells [m]
    for (std::size_t p = 0; p < count; ++p) {
      places[p].template head<D>() = particles.x[first + p];
      sizes[p] = std::pow(mesh_.volume(particles.cell[first + p]), Real{1} / D);
    }
    for (int d = 0; d < D; ++d)
      try {
        const std::string& formula = spec.velocity[static_cast<std::size_t>(d)];
        const auto values = evaluate(formula, places);
        const auto slopes = gradients(formula, places, sizes);
        for (std::size_t p = 0; p < count; ++p) {
          Vec<D> v = particles.v[first + p];
          v[d] = values[p];
          particles.v.set(first + p, v);
          Mat<D> L = particles.L[first + p];
          L.row(d) = slopes[p].template head<D>();
          particles.L.set(first + p, L);
        }
      } catch (const std::invalid_argument& e) {
        complaints_.add(spec.where, fmt::format("velocity[{}]", d), e.what());
      }
  }

  const Scene& scene_;
  const Mesh<D>& mesh_;
  Complaints& complaints_;
  Seeds<D> seeds_;
};

/// Cells that hold particles of two bodies: material there is counted twice, unless the shapes only touch.
template <int D>
void warn_of_shared_cells(const Seeds<D>& seeds, Index n_cells, std::vector<std::string>& warnings)
{
  std::vector<Index> owner(static_cast<std::size_t>(n_cells), none);
  for (std::size_t b = 0; b < seeds.bodies.size(); ++b) {
    std::vector<Index> shared(seeds.bodies.size(), 0);
    Index last = none;
    for (Index row = seeds.bodies[b].begin; row < seeds.bodies[b].end; ++row) {
      const Index cell = seeds.particles.cell[static_cast<std::size_t>(row)];
      Index& holds = owner[static_cast<std::size_t>(cell)];
      if (holds != none && holds != static_cast<Index>(b) && cell != last)
        ++shared[static_cast<std::size_t>(holds)];
      if (holds == none)
        holds = static_cast<Index>(b);
      last = cell;
    }
    for (std::size_t other = 0; other < b; ++other)
      if (shared[other] > 0)
        warnings.push_back(fmt::format("{}: bodies \"{}\" and \"{}\" share {} cell{} at the start", to_string(seeds.bodies[b].where),
                                       seeds.bodies[other].name, seeds.bodies[b].name, shared[other], shared[other] == 1 ? "" : "s"));
  }
}

}  // namespace

template <int D>
Seeds<D> seed(const Scene& scene, const Mesh<D>& mesh, Complaints& complaints, std::vector<std::string>& warnings)
{
  Seeder<D> seeder(scene, mesh, complaints);
  for (const BodySpec& body : scene.bodies)
    seeder.add(body);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!scene.bodies[i].region.empty() && scene.bodies[i].region == scene.bodies[j].region)
        complaints.add(scene.bodies[i].where, "region",
                       fmt::format("body \"{}\" fills the cell group \"{}\" already", scene.bodies[j].name, scene.bodies[i].region));
  Seeds<D> seeds = seeder.take();
  warn_of_shared_cells(seeds, mesh.n_cells(), warnings);
  return seeds;
}

template Seeds<2> seed<2>(const Scene&, const Mesh<2>&, Complaints&, std::vector<std::string>&);
template Seeds<3> seed<3>(const Scene&, const Mesh<3>&, Complaints&, std::vector<std::string>&);

}  // namespace talus
