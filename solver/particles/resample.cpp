#include "solver/particles/resample.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "solver/particles/removal.hpp"

namespace talus {

namespace {

std::size_t at_row(Index i) noexcept { return static_cast<std::size_t>(i); }

/// The longest side of a domain: its length [m], its direction, and the unit vector that the domain maps to that.
template <int D>
struct LongestSide {
  Real length;
  Vec<D> direction, material;
};

template <int D>
LongestSide<D> longest_side(const Mat<D>& domain) noexcept
{
  using Square = Eigen::Matrix<Real, D, D>;
  const Square edges = domain;
  const Eigen::JacobiSVD<Square> svd(edges, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.singularValues()[0], svd.matrixU().col(0), svd.matrixV().col(0)};
}

template <int D>
const ParticleColumn<Mat<D>>& affine_field_of(const Particles<D>& particles) noexcept
{
  return particles.C.empty() ? particles.L : particles.C;
}

/// Half the distance between the halves, at most the size of the cell [m]: farther away a rank does not know the mesh.  Shorter where one
/// half would lie outside the mesh; nothing if it does then as well.
template <int D>
std::optional<Vec<D>> offset_of_halves(const Mesh<D>& mesh, const Locator<D>& locator, const Vec<D>& x, Index cell,
                                       const LongestSide<D>& side, Real size) noexcept
{
  for (const Real share : {1.0, 0.5, 0.25}) {
    const Vec<D> offset = share * std::min(side.length / 4, size) * side.direction;
    if (locator(mesh, x + offset, cell) && locator(mesh, x - offset, cell))
      return offset;
  }
  return std::nullopt;
}

/// The centre of mass of two rows.
template <int D>
Vec<D> centre_of(const Particles<D>& particles, Index a, Index b) noexcept
{
  const Real m = particles.mass[at_row(a)], other = particles.mass[at_row(b)];
  return (m * particles.x[at_row(a)] + other * particles.x[at_row(b)]) / (m + other);
}

/// Adds so many pairs of rows of a cell, ascending in their ids, that are to be merged, as far as there are pairs whose centre is in the mesh.
template <int D>
void pair_nearest(const Mesh<D>& mesh, const Locator<D>& locator, const Particles<D>& particles, Index cell, std::span<const Index> rows,
                  Index surplus, std::vector<std::pair<Index, Index>>& pairs)
{
  std::vector<std::uint8_t> taken(rows.size(), 0);
  while (surplus > 0) {
    Real least = std::numeric_limits<Real>::infinity();
    std::pair<std::size_t, std::size_t> nearest;
    for (std::size_t a = 0; a < rows.size(); ++a)
      for (std::size_t b = a + 1; b < rows.size() && taken[a] == 0; ++b)
        if (const Real d = (particles.x[at_row(rows[a])] - particles.x[at_row(rows[b])]).squaredNorm(); taken[b] == 0 && d < least)
          least = d, nearest = {a, b};
    if (!(least < std::numeric_limits<Real>::infinity()))
      return;
    taken[nearest.second] = 1;
    const Index row = rows[nearest.first], other = rows[nearest.second];
    if (!locator(mesh, centre_of(particles, row, other), cell))
      continue;
    taken[nearest.first] = 1;
    pairs.emplace_back(row, other);
    --surplus;
  }
}

/// Whether matter has expanded so far that it flies apart: splitting it would only add particles.
template <int D>
bool is_spray(const Particles<D>& particles, Index row) noexcept
{
  constexpr Real most = 8;
  return particles.volume[at_row(row)] > most * particles.volume0[at_row(row)];
}

/// What counts of a particle in the balances.
template <int D>
ResampleSums<D> balances_of(const Particles<D>& particles, Index row) noexcept
{
  const Totals<D> of = totals_of(particles, at_row(row));
  return {.kinetic = of.kinetic, .momentum = {of.momentum, of.angular, 0, 0}};
}

/// The loss from `before` to `after`, as a summand of the balances.
template <int D>
ResampleSums<D> lost_between(const ResampleSums<D>& before, const ResampleSums<D>& after) noexcept
{
  return {
      .kinetic = before.kinetic - after.kinetic,
      .momentum = ForceAndMoment<D>::of(after.momentum.linear - before.momentum.linear, after.momentum.angular - before.momentum.angular)};
}
template <int D>
ResampleSums<D> sum_of(const ResampleSums<D>& a, const ResampleSums<D>& b) noexcept
{
  return {.kinetic = a.kinetic + b.kinetic, .momentum = a.momentum + b.momentum};
}

/// Makes a row one of the halves, which lies at `offset` from where the particle was.
template <int D>
void halve(const Vec<D>& offset, const Vec<D>& material, Particles<D>& particles, std::size_t p)
{
  const Mat<D> F = particles.F[p].template topLeftCorner<D, D>();
  particles.x.set(p, particles.x[p] + offset);
  particles.v.set(p, particles.v[p] + affine_field_of(particles)[p] * offset);
  // Where F is more than the deformation of what the particle covers, as after merging, the place at the start is within its size then.
  if (Vec<D> at_start = F.inverse() * offset; !particles.x0.empty() && at_start.allFinite()) {
    const Real size = std::pow(particles.volume0[p], 1.0 / D);
    at_start *= std::min(Real{1}, size / at_start.norm());
    particles.x0.set(p, particles.x0[p] + at_start);
  }
  for (ParticleColumn<Real>* column : {&particles.mass, &particles.volume0, &particles.volume})
    column->set(p, (*column)[p] / 2);
  if (!particles.applied.empty())
    particles.applied.set(p, particles.applied[p] / 2);
  const Mat<D> domain = particles.domain[p];
  particles.domain.set(p, domain * (Mat<D>::Identity() - material * material.transpose() / 2));
}

/// The mean of two rows of a column with weights, in the first of them.
template <class Value>
void average_rows(ParticleColumn<Value>& column, const std::array<std::size_t, 2>& rows, const std::array<Real, 2>& weight)
{
  if (!column.empty())
    column.set(rows[0], (weight[0] * column[rows[0]] + weight[1] * column[rows[1]]) / (weight[0] + weight[1]));
}
template <class Value>
void add_rows(ParticleColumn<Value>& column, const std::array<std::size_t, 2>& rows)
{
  if (!column.empty())
    column.set(rows[0], column[rows[0]] + column[rows[1]]);
}

/// Makes a row both particles.
template <int D>
void unite_rows(const std::array<std::size_t, 2>& rows, Material& material, Particles<D>& particles)
{
  const auto weights = [&](const ParticleColumn<Real>& column) { return std::array{column[rows[0]], column[rows[1]]}; };
  const std::array by_mass = weights(particles.mass), by_volume0 = weights(particles.volume0), by_volume = weights(particles.volume);
  const Mat3 of_larger = particles.F[rows[by_volume0[0] < by_volume0[1] ? 1 : 0]];
  average_rows(particles.x, rows, by_mass), average_rows(particles.v, rows, by_mass), average_rows(particles.x0, rows, by_mass);
  average_rows(particles.L, rows, by_mass), average_rows(particles.C, rows, by_mass), average_rows(particles.F, rows, by_volume0);
  for (ParticleColumn<Real>* column :
       {&particles.volume_ratio, &particles.viscous, &particles.pore, &particles.water, &particles.water_at_rest})
    average_rows(*column, rows, by_volume);
  average_rows(particles.stress, rows, by_volume), average_rows(particles.water_gradient, rows, by_volume);
  average_rows(particles.jump_stress, rows, by_volume);
  add_rows(particles.mass, rows), add_rows(particles.volume0, rows), add_rows(particles.volume, rows), add_rows(particles.applied, rows);

  const std::size_t p = rows[0];
  const Real volume = particles.volume[p], ratio = volume / particles.volume0[p];
  Mat3 F = particles.F[p];
  // The mean of deformations that differ much may turn inside out: then it is that of the larger particle.
  if (constexpr Real least = 0.5; !(F.determinant() > least * ratio))
    F = of_larger;
  F.template topLeftCorner<D, D>() *= std::pow(ratio / F.determinant(), 1.0 / D);
  particles.F.set(p, F);
  particles.domain.set(p, std::pow(volume, 1.0 / D) * Mat<D>::Identity());
  Real* const history = material.history.row(static_cast<Index>(p) - material.begin);
  const Real* const other = material.history.row(static_cast<Index>(rows[1]) - material.begin);
  for (int k = 0; k < material.history.width(); ++k)
    history[k] = (by_volume0[0] * history[k] + by_volume0[1] * other[k]) / (by_volume0[0] + by_volume0[1]);
}

/// The ids of all ranks, ascending, on all of them.  Collective.
std::vector<std::int64_t> all_ids(Communicator& ranks, std::vector<std::int64_t> ids)
{
  if (!ranks.alone()) {
    std::vector<std::int64_t> all;
    for (const auto& of_rank : gather_rows<std::int64_t>(ranks, ids))
      all.insert(all.end(), of_rank.begin(), of_rank.end());
    const auto bytes = std::as_bytes(std::span(all));
    std::vector<std::byte> sent(bytes.begin(), bytes.end());
    ranks.broadcast(sent, 0);
    ids.resize(sent.size() / sizeof(std::int64_t));
    if (!sent.empty())
      std::memcpy(ids.data(), sent.data(), sent.size());
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// Copies of the particles that are split, in the order of the plan.
template <int D>
ParticleSet<D> copies_of(const ResamplePlan<D>& plan, const std::vector<Body>& bodies, const std::vector<Material>& materials,
                         const Particles<D>& particles)
{
  ParticleSet<D> copies{bodies, {}, {}};
  std::vector<const std::byte*> rows;  // of each column, nullptr where it has none
  particles.for_each_column([&](std::string_view, std::string_view, const auto& column) {
    rows.push_back(column.empty() ? nullptr : reinterpret_cast<const std::byte*>(numbers_of(column, 0)));
  });
  std::size_t number = 0;
  copies.particles.for_each_column([&](std::string_view, std::string_view, auto& column) {
    const std::byte* const from = rows[number++];
    if (from == nullptr)
      return;
    column.resize(plan.split.size());
    for (std::size_t k = 0; k < plan.split.size(); ++k)
      load_row(from + row_bytes<std::decay_t<decltype(column)>> * at_row(plan.split[k].row), column, k);
  });
  auto next = plan.split.begin();
  Index begin = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    Material& material = copies.materials.emplace_back(materials[b].without_particles());
    const auto first = next;
    next = std::find_if(first, plan.split.end(), [&](const auto& one) { return one.row >= bodies[b].end; });
    Body& body = copies.bodies[b];
    body.begin = begin, body.end = begin += static_cast<Index>(next - first);
    material.set_range(body);
    material.history.resize(body.size());
    for (Index i = 0; i < body.size(); ++i)
      std::ranges::copy(materials[b].history.bytes_of_row((first + i)->row - bodies[b].begin), material.history.bytes_of_row(i).begin());
  }
  return copies;
}

Material& material_of(std::vector<Material>& materials, std::size_t row) noexcept
{
  return *std::ranges::find_if(materials, [&](const Material& one) { return static_cast<Index>(row) < one.end; });
}

}  // namespace

template <int D>
ResamplePlan<D> plan_resampling(const Mesh<D>& mesh, const Locator<D>& locator, std::span<const std::optional<ResampleOptions>> options,
                                const TrackedIds& kept, const std::vector<Body>& bodies, const Particles<D>& particles,
                                const CellOrder& order)
{
  ResamplePlan<D> plan;
  std::vector<Index> free;  // of one cell, neither split nor kept
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!options[b] || bodies[b].size() == 0)
      continue;
    const auto of_body = std::span(order.row).subspan(at_row(bodies[b].begin), at_row(bodies[b].size()));
    const Index most = options[b]->most.value();
    for (std::size_t first = 0, end = 0; first < of_body.size(); first = end) {
      const Index cell = particles.cell[at_row(of_body[first])];
      while (end < of_body.size() && particles.cell[at_row(of_body[end])] == cell)
        ++end;
      const auto count = static_cast<Index>(end - first);
      Index room = most - count;
      free.clear();
      const Real size = std::pow(mesh.volume(cell), 1.0 / D), longest = options[b]->longest * size;
      for (const Index row : of_body.subspan(first, end - first)) {
        const Mat<D> domain = particles.domain[at_row(row)];
        if (kept.place(particles.id[at_row(row)]) || !domain.allFinite())
          continue;
        free.push_back(row);
        // No singular value is larger than this norm.
        if (room <= 0 || domain.squaredNorm() <= longest * longest || is_spray(particles, row))
          continue;
        const LongestSide<D> side = longest_side<D>(domain);
        if (!(side.length > longest))
          continue;
        if (const auto offset = offset_of_halves(mesh, locator, particles.x[at_row(row)], cell, side, size)) {
          plan.split.push_back({row, *offset, side.material});
          free.pop_back();
          --room;
        }
      }
      pair_nearest(mesh, locator, particles, cell, free, count - most, plan.merge);
    }
  }
  std::ranges::sort(plan.split, {}, &ResamplePlan<D>::Split::row);
  return plan;
}

template <int D>
void resample(const ResamplePlan<D>& plan, std::int64_t splits, Communicator& ranks, std::vector<Body>& bodies,
              std::vector<Material>& materials, Particles<D>& particles, ExactSums<ResampleSums<D>>& sums)
{
  std::vector<std::int64_t> ids;
  for (const auto& one : plan.split)
    ids.push_back(particles.id[at_row(one.row)]);
  const std::vector<std::int64_t> of_all = all_ids(ranks, ids);

  ParticleSet<D> halves = copies_of(plan, bodies, materials, particles);
  for (std::size_t k = 0; k < plan.split.size(); ++k) {
    const auto& [row, offset, material] = plan.split[k];
    const ResampleSums<D> before = balances_of(particles, row);
    halve<D>(offset, material, particles, at_row(row));
    halve<D>(-offset, material, halves.particles, k);
    halves.particles.id[k] = first_resampled_id + splits + (std::ranges::lower_bound(of_all, ids[k]) - of_all.begin());
    ResampleSums<D> lost = lost_between(before, sum_of(balances_of(particles, row), balances_of(halves.particles, static_cast<Index>(k))));
    lost.splits = 1;
    sums.add(lost);
  }
  for (const auto& [row, other] : plan.merge) {
    const ResampleSums<D> before = sum_of(balances_of(particles, row), balances_of(particles, other));
    unite_rows({at_row(row), at_row(other)}, material_of(materials, at_row(row)), particles);
    particles.cell[at_row(other)] = none;
    ResampleSums<D> lost = lost_between(before, balances_of(particles, row));
    lost.merges = 1;
    sums.add(lost);
  }
  drop_lost(bodies, materials, particles);
  insert_particles(std::move(halves), bodies, materials, particles);
}

#define TALUS_INSTANTIATE(D)                                                                                                             \
  template ResamplePlan<D> plan_resampling(const Mesh<D>&, const Locator<D>&, std::span<const std::optional<ResampleOptions>>,           \
                                           const TrackedIds&, const std::vector<Body>&, const Particles<D>&, const CellOrder&);          \
  template void resample(const ResamplePlan<D>&, std::int64_t, Communicator&, std::vector<Body>&, std::vector<Material>&, Particles<D>&, \
                         ExactSums<ResampleSums<D>>&);
TALUS_INSTANTIATE(2)
TALUS_INSTANTIATE(3)
#undef TALUS_INSTANTIATE

}  // namespace talus
