#include "app/observers/history.hpp"

#include <algorithm>
#include <numeric>

#include "io/output/history_columns.hpp"

namespace talus {

namespace {

constexpr Real empty_entry = std::numeric_limits<Real>::quiet_NaN();

/// The value that the fraction `share` of the mass does not exceed, from value and mass of particles of all ranks.  NaN if there are none,
/// and on ranks other than the root.
Real not_exceeded_by(Real share, const std::vector<Vec<2>>& here, Communicator& ranks)
{
  std::vector<std::pair<Real, Real>> all;
  for (const std::vector<Vec<2>>& of_rank : gather_rows<Vec<2>>(ranks, here))
    for (const Vec<2>& one : of_rank)
      all.emplace_back(one[0], one[1]);
  if (all.empty())
    return empty_entry;
  std::ranges::sort(all);
  const Real total = std::accumulate(all.begin(), all.end(), Real{0}, [](Real sum, const auto& one) { return sum + one.second; });
  std::size_t i = 0;
  Real mass = all[0].second;
  const Real wanted = share * total * (1 - 1e-12);  // the sum of the masses in another order may differ by round-off
  while (mass < wanted && i + 1 < all.size())
    mass += all[++i].second;
  return all[i].first;
}

void put(Real value, std::vector<Real>& row) { row.push_back(value); }
template <int N>
void put(const Vec<N>& value, std::vector<Real>& row)
{
  row.insert(row.end(), value.begin(), value.end());
}

/// The values of a table of io/output/history_columns.hpp for `owner`.
template <int D, class Table, class Owner>
void put_all(const Table& table, const Owner& owner, std::vector<Real>& row)
{
  for_each_quantity(table, [&]<QuantityKind kind, class Value>(const Quantity<kind, Value>& column) {
    const auto value = value_of<D>(column, owner);
    if constexpr (kind == QuantityKind::moment && D == 2)
      put(value[2], row);
    else
      put(value, row);
  });
}

/// Data for the columns: of the run, a wall, a point, the action of bodies on a wall, a body.
template <int D>
struct RunNow {
  const RunView<D>& run;
  Totals<D> totals;
  Vec<D> centre;  ///< centre of mass [m]; NaN without mass
  EnergyNow energy;
};
struct ResampleNow {
  const ResampleLedger& ledger;
  EnergyNow energy;
};
template <int D>
struct ReactionNow {
  Vec<D> reaction;  ///< reaction [N]
};
template <int D>
struct ContactNow {
  Vec<D> force;         ///< on the first body or side [N]
  Real friction, loss;  ///< [J]
};
template <int D>
struct RigidNow {
  const RigidState<D>& state;
  Vec<D> force;            ///< of material on it [N]
  Vec3 moment;             ///< about its centre [N m]
  Real kinetic, friction;  ///< [J]
};
template <int D>
struct PointNow {
  Vec<D> x, u, v;  ///< position [m], displacement [m], velocity [m/s]
  Sym3 stress;     ///< stress [Pa]
};
template <int D>
struct WallNow {
  Real push, shear, touched, pressure;  ///< normal force [N], shear force [N], area in contact [m^(D-1)], pressure [Pa]
  Vec<D> attack;                        ///< point of attack [m]
};
template <int D>
struct BodyNow {
  Real mass, kinetic, plastic;  ///< [kg], [J], [J]
  Vec<D> momentum, force;       ///< [kg m/s], [N]
};

/// Sums over the part of a wall with mass at its nodes: area vectors out of the mesh [m^(D-1)], their lengths, and lengths times positions
/// of the nodes.
template <int D>
struct Touched {
  Vec<D> area = Vec<D>::Zero(), place = Vec<D>::Zero();
  Real measure{};
};

/// The point where the line of action of a force [N] with a given moment [N m] about the origin crosses a plane through `place`; NaN if it
/// is parallel to the plane.
template <int D>
Vec<D> attack(const Vec<D>& force, const Vec3& moment, const Vec<D>& normal, const Vec<D>& place)
{
  const Real through = force.dot(normal);
  if (through == 0)
    return Vec<D>::Constant(empty_entry);
  Vec3 push = Vec3::Zero();
  push.template head<D>() = force;
  const Vec3 cross(push[1] * moment[2] - push[2] * moment[1], push[2] * moment[0] - push[0] * moment[2],
                   push[0] * moment[1] - push[1] * moment[0]);
  const Vec<D> foot = cross.template head<D>() / push.squaredNorm();  // the point of the line nearest to the origin
  return foot + (place - foot).dot(normal) / through * force;
}

template <int D>
std::vector<CsvColumn> joined(std::vector<CsvColumn> columns, const OwnColumns<D>& own)
{
  for (const CsvColumn& column : own.columns) {
    if (std::ranges::any_of(columns, [&](const CsvColumn& other) { return other.name == column.name; }))
      throw RunError(fmt::format("the script adds a column \"{}\", which history.csv has already: take another name", column.name));
    columns.push_back(column);
  }
  return columns;
}

}  // namespace

template <int D>
std::int64_t nearest_particle(const PointSpec& spec, const RunView<D>& view)
{
  const Vec<D> at = Eigen::Map<const Vec<D>>(spec.at.data());
  constexpr auto nobody = std::numeric_limits<std::int64_t>::max();
  std::pair<Real, std::int64_t> best{std::numeric_limits<Real>::infinity(), nobody};
  for_each_particle_of(view, spec.body, [&](const auto& p) { best = std::min(best, std::pair{(p.x() - at).squaredNorm(), p.id()}); });
  Communicator& ranks = *view.problem.ranks;
  const Real nearest = ranks.min(best.first);
  const std::int64_t id = ranks.min(best.first == nearest ? best.second : nobody);
  return id == nobody ? 0 : id;
}

template <int D>
std::optional<std::vector<Facet>> facets_of_wall(const Mesh<D>& mesh, const std::string& wall)
{
  auto facets = mesh.facet_set(wall);
  return facets ? facets : mesh.facet_set(wall.substr(0, wall.rfind('_')));
}

template <int D>
Real front(const FrontSpec& spec, const RunView<D>& view)
{
  const auto axis = static_cast<Index>(spec.direction) / 2;
  const Real sign = static_cast<Index>(spec.direction) % 2 == 0 ? 1 : -1;
  std::vector<Vec<2>> here;  // coordinate along the direction, mass
  for_each_particle_of(view, spec.body, [&](const auto& p) { here.push_back({sign * p.x()[axis], p.mass()}); });
  return sign * not_exceeded_by(spec.mass_share, here, *view.problem.ranks);
}

template <int D>
Real moved(const MovedSpec& spec, const RunView<D>& view)
{
  std::vector<Vec<2>> here;  // length of displacement, mass
  for_each_particle_of(view, spec.body, [&](const auto& p) { here.push_back({p.displacement().norm(), p.mass()}); });
  return not_exceeded_by(spec.mass_share, here, *view.problem.ranks);
}

template <int D>
std::vector<CsvColumn> HistoryWriter<D>::columns(const HistoryOutputSpec& spec, const RunView<D>& start)
{
  std::vector<CsvColumn> all;
  const auto add = [&](const auto& table, const std::string& owner) {
    const auto more = csv_columns(table, owner, D);
    all.insert(all.end(), more.begin(), more.end());
  };
  add(run_columns(), "");
  if (start.problem.flow.any())
    add(flow_columns(), "");
  if (any_resampled(start.problem.resampling))
    add(resample_columns(), "");
  if (start.problem.equations != nullptr)
    add(solve_columns(), "");
  for (const BoundaryCondition<D>& wall : start.state.boundary.conditions())
    add(reaction_columns(), wall.name);
  for (const ContactLaw& contact : start.problem.contacts.laws)
    add(contact_columns(), contact.name());
  for (const CutLaw& cut : start.problem.cuts)
    add(cut_columns(), cut.group);
  for (const RigidBody<D>& rigid : start.problem.rigid.bodies)
    add(rigid_columns(), rigid.name);
  for (const PointSpec& point : spec.points) {
    add(point_columns(), point.name);
    if (start.problem.flow.any())
      add(point_water_columns(), point.name);
  }
  for (const FrontSpec& one : spec.fronts)
    add(front_columns(), one.name);
  for (const WallSpec& wall : spec.walls)
    add(wall_columns(), wall.on);
  for (const MovedSpec& one : spec.moved)
    add(moved_columns(), one.name);
  for (const std::string& body : spec.bodies)
    add(body_columns(), body);
  return all;
}

template <int D>
HistoryWriter<D>::HistoryWriter(const std::filesystem::path& file, HistoryOutputSpec spec, OwnColumns<D> own, const RunView<D>& start)
    : spec_(std::move(spec)), own_(std::move(own))
{
  start.problem.ranks->together([&] { file_.emplace(file, joined(columns(spec_, start), own_)); });
  state_.impulse.assign(start.state.boundary.conditions().size(), Vec<D>::Zero());
  state_.angular.assign(start.state.boundary.conditions().size(), Vec3::Zero());
  state_.contact.assign(start.state.contacts.size(), Vec<D>::Zero());
  state_.rigid.assign(start.state.rigid.size(), {});
  state_.given.resize(spec_.bodies.size());
  for (const PointSpec& point : spec_.points)
    state_.followed.push_back(nearest_particle(point, start));
}

template <int D>
HistoryWriter<D>::HistoryWriter(const std::filesystem::path& file, HistoryOutputSpec spec, OwnColumns<D> own, const RunView<D>& now,
                                HistoryState<D> state)
    : spec_(std::move(spec)), own_(std::move(own)), state_(std::move(state))
{
  now.problem.ranks->together([&] { file_.emplace(HistoryFile::resume(file, joined(columns(spec_, now), own_), now.state.clock.time)); });
}

template <int D>
void HistoryWriter<D>::append(const RunView<D>& view, const BalanceHistory<D>& accounts, const BodyForces<D>& forces)
{
  const Totals<D> sums = totals(view);
  const Vec<D> centre = sums.mass > 0 ? Vec<D>(sums.centre / sums.mass) : Vec<D>(Vec<D>::Constant(empty_entry));
  std::vector<Real> row;
  const EnergyNow energy = accounts.energy(view);
  put_all<D>(run_columns(), RunNow<D>{view, sums, centre, energy}, row);
  if (view.problem.flow.any())
    put_all<D>(flow_columns(), view.state.flow, row);
  if (any_resampled(view.problem.resampling))
    put_all<D>(resample_columns(), ResampleNow{view.state.resampling, energy}, row);
  if (view.problem.equations != nullptr)
    put_all<D>(solve_columns(), view.state.solve, row);
  const Real elapsed = view.state.clock.time - state_.time;
  for (std::size_t w = 0; w < state_.impulse.size(); ++w) {
    const Vec<D>& impulse = view.state.boundary.conditions()[w].impulse;
    const Vec<D> reaction = elapsed > 0 ? Vec<D>((impulse - state_.impulse[w]) / elapsed) : Vec<D>(Vec<D>::Zero());
    put_all<D>(reaction_columns(), ReactionNow<D>{reaction}, row);
  }
  for (std::size_t k = 0; k < state_.contact.size(); ++k) {
    const ContactSums<D>& contact = view.state.contacts[k];
    const Vec<D> force = elapsed > 0 ? Vec<D>((contact.impulse - state_.contact[k]) / elapsed) : Vec<D>(Vec<D>::Zero());
    put_all<D>(contact_columns(), ContactNow<D>{force, 0 - contact.friction, 0 - contact.pressure}, row);
    state_.contact[k] = contact.impulse;
  }
  for (std::size_t r = 0; r < state_.rigid.size(); ++r) {
    const RigidState<D>& rigid = view.state.rigid[r];
    const RigidSums<D>& before = state_.rigid[r];
    RigidNow<D> now{rigid, Vec<D>::Zero(), Vec3::Zero(), rigid.kinetic(view.problem.rigid.bodies[r]), 0 - rigid.done.friction};
    if (elapsed > 0)
      now.force = (before.impulse - rigid.done.impulse) / elapsed, now.moment = (before.torque - rigid.done.torque) / elapsed;
    put_all<D>(rigid_columns(), now, row);
    state_.rigid[r] = rigid.done;
  }
  add_points(view, row);
  for (const FrontSpec& spec : spec_.fronts)
    put_all<D>(front_columns(), front(spec, view), row);
  for (const WallSpec& spec : spec_.walls)
    add_wall(view, spec, elapsed, row);
  for (std::size_t w = 0; w < state_.impulse.size(); ++w) {
    state_.impulse[w] = view.state.boundary.conditions()[w].impulse;
    state_.angular[w] = view.state.boundary.conditions()[w].angular;
  }
  for (const MovedSpec& spec : spec_.moved)
    put_all<D>(moved_columns(), moved(spec, view), row);
  for (std::size_t k = 0; k < spec_.bodies.size(); ++k)
    add_body(view, forces, k, elapsed, row);
  if (own_.row) {
    const std::vector<Real> more = own_.row(view);
    row.insert(row.end(), more.begin(), more.end());
  }
  view.problem.ranks->together([&] { file_->append(row); });
  last_row_ = row;
  state_.time = view.state.clock.time;
}

template <int D>
void HistoryWriter<D>::add_body(const RunView<D>& view, const BodyForces<D>& forces, std::size_t k, Real elapsed, std::vector<Real>& row)
{
  const auto named = std::ranges::find(view.state.bodies, spec_.bodies[k], &Body::name);
  const auto b = static_cast<std::size_t>(named - view.state.bodies.begin());
  const BodySums<D>& sums = forces.sums()[b];
  const BodyImpulse<D>&before = state_.given[k], &now = forces.impulses()[b];
  const auto number = static_cast<Index>(b);
  const Real plastic = plastic_work(view, {number, number + 1});
  Vec<D> force = Vec<D>::Zero();
  if (now.unknown != before.unknown)
    force = Vec<D>::Constant(empty_entry);
  else if (elapsed > 0)
    force = (now.given - before.given) / elapsed;
  put_all<D>(body_columns(), BodyNow<D>{sums.mass, sums.kinetic, plastic, sums.momentum, force}, row);
  state_.given[k] = now;
}

/// The mean force on the wall since the previous row, its point of attack, and the area with mass.
template <int D>
void HistoryWriter<D>::add_wall(const RunView<D>& view, const WallSpec& spec, Real elapsed, std::vector<Real>& row) const
{
  const auto walls = view.state.boundary.conditions();
  const auto wall = std::ranges::find(walls, spec.on, &BoundaryCondition<D>::name);
  const auto w = static_cast<std::size_t>(wall - walls.begin());
  const MeshTraction<D> on_nodes =
      carried_by_mesh<D>(view.problem.mesh, facets_of_wall(view.problem.mesh, spec.on).value_or(std::vector<Facet>()));
  ExactSums<Touched<D>> sum;
  for (std::size_t i = 0; i < on_nodes.node.size(); ++i) {
    const Index n = on_nodes.node[i];
    const bool counted = view.problem.subdomain.alone() || view.problem.subdomain.owns_node(n);
    const auto is_active = [&](const VelocityField<D>& field) { return field.nodes.active[static_cast<std::size_t>(n)] != 0; };
    if (counted && std::ranges::any_of(view.fields, is_active))
      sum.add({on_nodes.area[i], on_nodes.measure[i] * view.problem.mesh.node(n), on_nodes.measure[i]});
  }
  view.problem.ranks->sum(sum);
  const Touched<D> touched = sum.value();
  const Real area = touched.area.norm();
  const Vec<D> force = elapsed > 0 ? Vec<D>((state_.impulse[w] - wall->impulse) / elapsed) : Vec<D>(Vec<D>::Zero());  // force on the wall
  const Vec<D> nowhere = Vec<D>::Constant(empty_entry);
  if (!(area > 0) || force.norm() == 0) {
    const Real none_or_unknown = force.norm() == 0 ? 0 : empty_entry;  // material that has just left it acted on it
    put_all<D>(wall_columns(), WallNow<D>{none_or_unknown, none_or_unknown, area, area > 0 ? 0 : empty_entry, nowhere}, row);
    return;
  }
  const Vec<D> normal = touched.area / area;
  const Real push = force.dot(normal);
  const Vec3 moment = (state_.angular[w] - wall->angular) / elapsed;
  const Vec<D> attacked = attack<D>(force, moment, normal, touched.place / touched.measure);
  put_all<D>(wall_columns(), WallNow<D>{push, (force - push * normal).norm(), area, push / area, attacked}, row);
}

template <int D>
void HistoryWriter<D>::follow_anew(const std::string& body, const RunView<D>& now)
{
  for (std::size_t k = 0; k < spec_.points.size(); ++k)
    if (spec_.points[k].body == body)
      state_.followed[k] = nearest_particle(spec_.points[k], now);
}

/// Adds position, displacement, velocity and stress of the particles of the points; no entries for those that are gone.
template <int D>
void HistoryWriter<D>::add_points(const RunView<D>& view, std::vector<Real>& row)
{
  const TrackedIds followed(state_.followed);
  struct FollowedParticle {
    std::size_t body = 0;
    std::vector<Real> values;
  };
  const bool flows = view.problem.flow.any();
  std::vector<FollowedParticle> here(followed.size());  // of each id
  if (!followed.empty())
    parallel_for_uneven(static_cast<Index>(view.order.keys()), [&](Index key) {
      for_each_particle(view, static_cast<std::size_t>(key), [&](const auto& p) {
        if (const auto place = followed.place(p.id())) {  // ids are unique: no other thread writes here
          here[*place].body = static_cast<std::size_t>(key / view.order.blocks);
          std::vector<Real>& values = here[*place].values;
          put_all<D>(point_columns(), PointNow<D>{p.x(), p.displacement(), p.v(), p.stress()}, values);
          if (flows)
            put_all<D>(point_water_columns(), p.water(), values);
        }
      });
    });
  for (std::size_t k = 0; k < spec_.points.size(); ++k) {
    const FollowedParticle& found = here[*followed.place(state_.followed[k])];
    const std::string& body = spec_.points[k].body;
    const bool is_there = body.empty() || view.state.bodies[found.body].name == body;
    std::vector<Real> point(csv_columns(point_columns(), "", D).size() + (flows ? csv_columns(point_water_columns(), "", D).size() : 0),
                            empty_entry);
    for (const std::vector<Real>& of_rank : gather_rows<Real>(*view.problem.ranks, is_there ? found.values : std::vector<Real>()))
      if (!of_rank.empty())
        point = of_rank;
    row.insert(row.end(), point.begin(), point.end());
  }
}

template std::optional<std::vector<Facet>> facets_of_wall<2>(const Mesh<2>&, const std::string&);
template std::optional<std::vector<Facet>> facets_of_wall<3>(const Mesh<3>&, const std::string&);
template std::int64_t nearest_particle<2>(const PointSpec&, const RunView<2>&);
template std::int64_t nearest_particle<3>(const PointSpec&, const RunView<3>&);
template Real front<2>(const FrontSpec&, const RunView<2>&);
template Real front<3>(const FrontSpec&, const RunView<3>&);
template Real moved<2>(const MovedSpec&, const RunView<2>&);
template Real moved<3>(const MovedSpec&, const RunView<3>&);
template class HistoryWriter<2>;
template class HistoryWriter<3>;

}  // namespace talus
