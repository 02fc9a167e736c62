#include "app/setup/seed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "app/setup/checks/shared_nodes.hpp"
#include "app/setup/laws_in_force.hpp"
#include "app/setup/parameter_fields.hpp"
#include "app/setup/setup.hpp"
#include "core/parallel/threads.hpp"
#include "io/system/memory.hpp"
#include "materials/interface/varied_law.hpp"
#include "mesh/digest.hpp"
#include "mesh/locate.hpp"
#include "mesh/quadrature.hpp"

namespace talus {

namespace {

Real density_of(const MaterialSpec& material) { return material.law.model()->density(); }

template <int D>
void make_room(std::size_t n, Particles<D>& p)
{
  const auto resize = [n](auto&... columns) { (columns.resize(n), ...); };
  resize(p.id, p.cell, p.x, p.v, p.L, p.F, p.stress, p.mass, p.volume0, p.volume);
}

/// Where the particles stand that a rank has counted, among those that all have.
struct Standing {
  std::int64_t before, all;  ///< of lower ranks; of all
};

Standing standing_of(std::int64_t here, Communicator& ranks)
{
  const std::vector<std::int64_t> counts = of_all_ranks(ranks, here);
  const auto mine = counts.begin() + ranks.rank();
  return {std::accumulate(counts.begin(), mine, std::int64_t{0}), std::accumulate(counts.begin(), counts.end(), std::int64_t{0})};
}

/// Fills one body after the other.  Bodies of another run are taken whole by every rank, until settle().
template <int D>
class Seeder {
 public:
  Seeder(const Scene& scene, const Mesh<D>& mesh, Communicator& ranks, SceneErrorCollector& errors)
      : scene_(scene), mesh_(mesh), ranks_(ranks), mine_(cells_to_fill(mesh, ranks)), errors_(errors)
  {}

  void add(const BodySpec& spec)
  {
    const auto points = seeding_points<D>(spec.particles_per_cell.value());
    if (!points)
      complain_of_count(spec);
    const auto cells = cells_of(spec);
    const MaterialSpec* material = first_material(spec);
    if (!points || !cells || material == nullptr)
      return;
    const Index begin = seeds_.particles.size();
    const std::vector<std::int64_t> first = count(*cells, *points, spec);
    const Standing standing = standing_of(first.back() - begin, ranks_);
    if (const std::string why = too_many_particles(standing.all, material->law); !why.empty())
      return errors_.add(spec.where, "particles_per_cell", why);
    fill(*cells, *points, spec, density_of(*material), first, seeds_.n_particles + standing.before);
    seeds_.n_particles += static_cast<Index>(standing.all);
    const Index end = seeds_.particles.size();
    if (standing.all == 0)
      errors_.add(spec.where, "",
                  fmt::format("the body has no particles: {}",
                              spec.shape ? "its shape contains no particle centre of the mesh" : "its group has no cells"));
    seeds_.bodies.push_back({spec.name, begin, end, spec.where});
    seeds_.materials.push_back(first_law(spec, begin, end));
    set_parameters_in_space(seeds_.particles, ranks_, errors_, seeds_.materials.back());
    set_velocity(spec, mesh_, ranks_, begin, end, errors_, seeds_.particles);
  }

  /// The body begins as the one of that number there.
  void add(const BodySpec& spec, InitialState<D>& initial, Index from)
  {
    const MaterialSpec* material = first_material(spec);
    if (material == nullptr)
      return;
    const Body& source = initial.there.bodies[static_cast<std::size_t>(from)];
    const Material& there = initial.there.materials[static_cast<std::size_t>(from)];
    const std::vector<Index> rows = rows_by_id(initial.there.particles, source);
    const Index begin = seeds_.particles.size(), end = begin + source.size();
    if (begin == end)
      errors_.add(spec.where, "", fmt::format("body \"{}\" has no particles left in {}", source.name, initial.origin.file));
    const Body body{spec.name, begin, end, spec.where};
    Material material_here = first_law(spec, begin, end);
    copy(initial.there.particles, rows, density_of(*material) / there.law().density(), begin, seeds_.n_particles);
    seeds_.n_particles += source.size();
    find_cells(body, source);
    if (material_here.law().name() == there.law().name()) {
      std::vector<Index> of_body(rows);
      for (Index& row : of_body)
        row -= source.begin;
      carry_history(there, of_body, material_here);
    } else if (!material_here.law().description().starts_from_stress) {
      errors_.add(spec.where, "material",
                  fmt::format("the particles come from law \"{}\", and law \"{}\" cannot start from their stress; of other laws {} can",
                              there.law().name(), material_here.law().name(), or_list(laws_that_start_from_stress())));
    }
    if (material_here.law().name() != there.law().name() || !varies_alike(material_here.law(), there.law()))
      set_parameters_in_space(seeds_.particles, ranks_, errors_, material_here);
    taken_.push_back({seeds_.bodies.size(), std::string(there.law().name()), rows});
    initial.origin.bodies.push_back({spec.name, source.name, source.size()});
    seeds_.bodies.push_back(body);
    seeds_.materials.push_back(std::move(material_here));
  }

  /// What concerns all bodies of another run together, once they are all there.
  void settle(const InitialState<D>& initial, std::vector<std::string>& warnings)
  {
    seeds_.water_flows_on = carry_columns(scene_, initial.there, std::span<const TakenParticles>(taken_), seeds_.bodies, seeds_.materials,
                                          errors_, seeds_.particles);
    const auto has_its_law = [&](const TakenParticles& taken) { return taken.law == seeds_.materials[taken.body].law().name(); };
    if (!initial.there.empty_cells.empty() && initial.origin.mesh_digest == fmt::format("{:016x}", digest(mesh_)) &&
        initial.there.empty_cells.fits(mesh_.n_cells()) && std::ranges::all_of(taken_, has_its_law))
      seeds_.empty_cells = initial.there.empty_cells;
    for (const auto& [body, law, rows] : taken_) {
      constexpr Real worth_a_word = 0.01;
      const Body& here = seeds_.bodies[body];
      const Material& material = seeds_.materials[body];
      const Real change = settle_stress(here, law, initial.there.clock.dt, ranks_, seeds_.materials[body], seeds_.particles);
      if (change > worth_a_word)
        warnings.push_back(fmt::format(
            "{}: the stress of body \"{}\" changes at the start, by up to {:.3g} % of the largest there: law \"{}\" makes another "
            "of the same state, with the constants of this scene",
            to_string(here.where), here.name, 100 * change, material.law().name()));
    }
    seeds_.origin = initial.origin;
    seeds_.lag = initial.there.clock.lag;
    seeds_.largest_before = initial.there.energy.largest_term(0);
    if (ranks_.alone())
      return;
    for (Index& cell : seeds_.particles.cell)
      cell = is_mine(cell) ? cell : none;
    drop_lost(seeds_.bodies, seeds_.materials, seeds_.particles);
  }

  Seeds<D> take() { return std::move(seeds_); }

 private:
  void complain_of_count(const BodySpec& spec)
  {
    std::vector<std::string> known;
    for (const int n : seeding_counts<D>())
      known.push_back(std::to_string(n));
    errors_.add(spec.where, "particles_per_cell",
                fmt::format("there is no symmetric set of {} points in a {}; there is {}", spec.particles_per_cell.value(),
                            D == 2 ? "triangle" : "tetrahedron", or_list(known)));
  }

  bool is_mine(Index cell) const noexcept { return mine_.begin <= cell && cell < mine_.end; }

  /// Those to be filled here.
  std::optional<std::vector<Index>> cells_of(const BodySpec& spec)
  {
    if (spec.shape) {
      std::vector<Index> all(static_cast<std::size_t>(mine_.end - mine_.begin));
      std::iota(all.begin(), all.end(), mine_.begin);
      return all;
    }
    auto cells = mesh_.cell_set(spec.region);
    if (!cells)
      errors_.unknown_group(spec.where, "region", "cell", spec.region, mesh_.cell_set_names());
    else
      std::erase_if(*cells, [&](Index c) { return !is_mine(c); });
    return cells;
  }

  Index first_stage(const BodySpec& spec) const { return presence_of(spec.name, scene_.stages).from; }
  /// If it is not there the reader has complained.
  const MaterialSpec* first_material(const BodySpec& spec) const { return material_of(scene_, spec, first_stage(spec)); }
  Material first_law(const BodySpec& spec, Index begin, Index end) const
  {
    Material material = law_in_force(scene_, spec, first_stage(spec));
    begin_anew(begin, end, material);
    return material;
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

  /// Why there cannot be so many more on all ranks; empty if there can.
  std::string too_many_particles(std::int64_t more, const AnyLaw& law) const
  {
    if (seeds_.n_particles + more > std::numeric_limits<Index>::max())
      return fmt::format("{} particles are more than can be numbered", seeds_.n_particles + more);
    Particles<D> one;
    make_room(1, one);
    const std::size_t bytes = bytes_of(one) + sizeof(Real) * static_cast<std::size_t>(law.description().history_width);
    const Real on_this_machine = static_cast<Real>(std::min(ranks_on_this_machine(), ranks_.size())) / ranks_.size();
    return ranks_.first(too_many(static_cast<Real>(more) * on_this_machine, "particles", static_cast<Real>(bytes)));
  }

  /// Rows for the particles of cells.
  void fill(const std::vector<Index>& cells, const std::vector<std::array<Real, D + 1>>& points, const BodySpec& spec, Real density,
            const std::vector<std::int64_t>& first, std::int64_t first_id)
  {
    Particles<D>& p = seeds_.particles;
    const auto all = static_cast<std::size_t>(first.back());
    make_room(all, p);
    parallel_for(static_cast<Index>(cells.size()), [&](Index i) {
      const Index cell = cells[i];
      const Real volume = mesh_.volume(cell) / static_cast<Real>(points.size());
      auto row = static_cast<std::size_t>(first[i]);
      for_each_place(cell, points, spec, [&](const Vec<D>& x) {
        p.id[row] = first_id + static_cast<std::int64_t>(row) - first.front();
        p.cell[row] = cell;
        p.x.set(row, x);
        p.v.set(row, Vec<D>::Zero());
        p.L.set(row, Mat<D>::Zero());
        p.F.set(row, Mat3::Identity());
        p.stress.set(row, Sym3::Zero());
        p.volume0.set(row, volume);
        p.volume.set(row, volume);
        p.mass.set(row, density * volume);
        ++row;
      });
    });
  }

  static std::vector<Index> rows_by_id(const Particles<D>& particles, const Body& body)
  {
    std::vector<Index> rows(static_cast<std::size_t>(body.size()));
    std::iota(rows.begin(), rows.end(), body.begin);
    std::ranges::sort(
        rows, [&](Index a, Index b) { return particles.id[static_cast<std::size_t>(a)] < particles.id[static_cast<std::size_t>(b)]; });
    return rows;
  }

  /// Rows behind those there are; masses change as the density of the material does.
  void copy(const Particles<D>& from, const std::vector<Index>& rows, Real heavier, Index begin, std::int64_t first_id)
  {
    Particles<D>& p = seeds_.particles;
    make_room(static_cast<std::size_t>(begin) + rows.size(), p);
    const bool moves = scene_.initial->velocity == Carried::keep;
    for_each_pair(begin, rows, [&](std::size_t row, std::size_t there) {
      p.id[row] = first_id + static_cast<std::int64_t>(row) - begin;
      p.x.set(row, from.x[there]);
      p.v.set(row, moves ? Vec<D>(from.v[there]) : Vec<D>(Vec<D>::Zero()));
      p.L.set(row, moves ? Mat<D>(from.L[there]) : Mat<D>(Mat<D>::Zero()));
      p.F.set(row, from.F[there]);
      p.stress.set(row, from.stress[there]);
      p.mass.set(row, heavier * from.mass[there]);
      p.volume0.set(row, from.volume0[there]);
      p.volume.set(row, from.volume[there]);
    });
  }

  void find_cells(const Body& body, const Body& source)
  {
    Particles<D>& p = seeds_.particles;
    const Locator<D> locator(mesh_);
    parallel_for(body.size(), [&](Index i) {
      const auto row = static_cast<std::size_t>(body.begin + i);
      p.cell[row] = locator(mesh_, p.x[row], none).value_or(none);
    });
    const auto first = p.cell.begin() + body.begin, last = p.cell.begin() + body.end;
    const auto outside = std::find(first, last, none);
    if (outside == last)
      return;
    const Vec<D> x = p.x[static_cast<std::size_t>(outside - p.cell.begin())];
    errors_.add(scene_.initial->where, "from",
                fmt::format("{} of the {} particles of body \"{}\" there lie outside the mesh of this scene, the first at ({:.6g})",
                            std::count(outside, last, none), body.size(), source.name, fmt::join(x.begin(), x.end(), ", ")));
    std::replace(outside, last, none, Index{0});  // the scene is refused, but looked at to its end
  }

  const Scene& scene_;
  const Mesh<D>& mesh_;
  Communicator& ranks_;
  IndexRange mine_;  // cells
  SceneErrorCollector& errors_;
  Seeds<D> seeds_;
  std::vector<TakenParticles> taken_;
};

}  // namespace

template <int D>
IndexRange cells_to_fill(const Mesh<D>& mesh, const Communicator& ranks)
{
  const std::int64_t blocks = blocks_of(mesh.n_cells());
  const auto begin_of = [&](int rank) {
    return static_cast<Index>(std::min<std::int64_t>(blocks * rank / ranks.size() * block_cells, mesh.n_cells()));
  };
  return {begin_of(ranks.rank()), begin_of(ranks.rank() + 1)};
}

template <int D>
Seeds<D> seed(const Scene& scene, const Mesh<D>& mesh, Communicator& ranks, SceneErrorCollector& errors, std::vector<std::string>& warnings)
{
  Seeder<D> seeder(scene, mesh, ranks, errors);
  auto initial = find_initial_state<D>(scene, errors, warnings);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (initial && initial->source[b] != none)
      seeder.add(scene.bodies[b], *initial, initial->source[b]);
    else if (scene.bodies[b].fills())  // if not, somebody has complained
      seeder.add(scene.bodies[b]);
  if (initial)
    seeder.settle(*initial, warnings);
  find_groups_filled_twice(scene, errors);
  Seeds<D> seeds = seeder.take();
  warn_of_shared_cells(scene, seeds.bodies, seeds.particles.cell, mesh.n_cells(), ranks, warnings);
  return seeds;
}

template IndexRange cells_to_fill<2>(const Mesh<2>&, const Communicator&);
template IndexRange cells_to_fill<3>(const Mesh<3>&, const Communicator&);
template Seeds<2> seed<2>(const Scene&, const Mesh<2>&, Communicator&, SceneErrorCollector&, std::vector<std::string>&);
template Seeds<3> seed<3>(const Scene&, const Mesh<3>&, Communicator&, SceneErrorCollector&, std::vector<std::string>&);

}  // namespace talus
