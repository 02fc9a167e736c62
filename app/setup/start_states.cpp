#include "app/setup/start_states.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>

#include "app/setup/checks/start_distances.hpp"
#include "app/setup/flow_of_scene.hpp"
#include "app/setup/laws_in_force.hpp"
#include "core/parallel/threads.hpp"
#include "io/points/start_points.hpp"
#include "mesh/digest.hpp"

namespace talus {

namespace {

/// How the law of a body takes the stress of the table.
struct StressTaken {
  bool adds_pore = false;   ///< the stress of the table is total, the law asks for the effective one
  bool drops_pore = false;  ///< the other way round
  bool has_pore = false;    ///< the particle carries pore pressure
};

/// How many particles something is said of, and the least number of one.
struct PlacesFound {
  std::int64_t count = 0, first = std::numeric_limits<std::int64_t>::max();
  PlacesFound& operator+=(const PlacesFound& other) noexcept
  {
    count += other.count, first = std::min(first, other.first);
    return *this;
  }
};

/// What is found over all particles of a body.
struct Extremes {
  Real largest = 0, change = 0, pore_apart = 0, pore_largest = 0;
  std::int64_t outside = 0, pulled = 0;
  PlacesFound unknown{}, refused{};  ///< through whose points no plane fits; whose stress the law does not take
  Extremes& operator+=(const Extremes& other) noexcept
  {
    largest = std::max(largest, other.largest), change = std::max(change, other.change);
    pore_apart = std::max(pore_apart, other.pore_apart);
    pore_largest = std::max(pore_largest, other.pore_largest);
    outside += other.outside, pulled += other.pulled;
    unknown += other.unknown, refused += other.refused;
    return *this;
  }
};

std::vector<HistoryVariable> scalars_of(const ConstitutiveLaw& law)
{
  std::vector<HistoryVariable> scalars;
  std::ranges::copy_if(law.variables(), std::back_inserter(scalars), [](const HistoryVariable& one) { return one.components == 1; });
  return scalars;
}

std::uint64_t digest_of(const StartPoints& points)
{
  std::vector<Real> numbers;
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    numbers.insert(numbers.end(), points.x[i].begin(), points.x[i].end());
    numbers.insert(numbers.end(), points.stress[i].begin(), points.stress[i].end());
  }
  numbers.insert(numbers.end(), points.pore.begin(), points.pore.end());
  for (const auto* vectors : {&points.velocity, &points.displacement})
    for (const auto& vector : *vectors)
      numbers.insert(numbers.end(), vector.begin(), vector.end());
  for (const auto& [key, values] : points.history)
    numbers.insert(numbers.end(), values.begin(), values.end());
  return digest(std::span<const Real>(numbers));
}

/// One body and its table.
template <int D>
class StartOfBody {
 public:
  StartOfBody(const Scene& scene, const BodySpec& spec, std::size_t number, const Mesh<D>& mesh, Communicator& ranks,
              SceneErrorCollector& errors, Setup<D>& setup)
      : scene_(scene),
        spec_(spec),
        start_(*spec.initial),
        mesh_(mesh),
        ranks_(ranks),
        errors_(errors),
        setup_(setup),
        body_(setup.state.bodies[number]),
        material_(setup.state.materials[number]),
        particles_(setup.state.particles),
        file_((folder_of(scene) / start_.table).lexically_normal())
  {}

  void set()
  {
    if (!material_.law().description().starts_from_stress)
      return errors_.add(
          spec_.where, "initial",
          fmt::format("law \"{}\" cannot start from a stress; {} can", material_.law().name(), or_list(laws_that_start_from_stress())));
    if (!read() || !decide())
      return;
    const PointCloud<D> cloud(places());
    const std::optional<Real> farthest = distance_from_points(cloud, spec_, file_.string(), body_, particles_, ranks_, errors_);
    if (!farthest)
      return;
    take_all(cloud);
    if (taken_by_all())
      report(*farthest);
  }

 private:
  std::size_t row(Index i) const noexcept { return static_cast<std::size_t>(body_.begin + i); }

  bool read()
  {
    try {
      points_ = read_start_points(start_, file_, D, scalars_of(material_.law()));
    } catch (const SceneErrors& wrong) {
      errors_.add(start_.where, "table", wrong);
      return false;
    } catch (const EnvironmentError& wrong) {
      errors_.add(start_.where, "table", wrong.what());
      return false;
    }
    setup_.start_digest.push_back(std::bit_cast<Real>(digest_of(points_)));
    if (!points_.velocity.empty() && !spec_.velocity.empty())
      errors_.add(spec_.where, "velocity", "the table has velocities: leave this out, or give initial: {velocity: zero}");
    return true;
  }

  /// Whether it is known what the law takes: effective stress in drained bodies, total stress in others.
  bool decide()
  {
    const bool pore = !points_.pore.empty(), drained = scene_.water && is_drained(*scene_.water, spec_.name);
    if (drained) {
      taken_ = {.adds_pore = !points_.is_effective, .has_pore = pore};
      if (!points_.is_effective && !pore)
        errors_.add(start_.where, "table",
                    fmt::format("the stress in {} is total, and the law of body \"{}\" takes effective stress: a column pore_pressure is "
                                "needed, or stress: effective",
                                file_.string(), spec_.name));
      return points_.is_effective || pore;
    }
    taken_ = {.drops_pore = points_.is_effective && pore};
    if (points_.is_effective && !pore && scene_.water)
      errors_.add(start_.where, "table",
                  fmt::format("the stress in {} is effective, and the law of the undrained body \"{}\" takes total stress: a column "
                              "pore_pressure is needed, or stress: total",
                              file_.string(), spec_.name));
    return !points_.is_effective || pore || !scene_.water;
  }

  std::vector<Vec<D>> places() const
  {
    std::vector<Vec<D>> all;
    for (const auto& x : points_.x)
      all.push_back(Eigen::Map<const Vec<D>>(x.data()));
    return all;
  }

  void take_all(const PointCloud<D>& cloud)
  {
    if (taken_.has_pore && particles_.pore.empty())
      particles_.pore.assign(particles_.id.size(), 0);
    if (start_.displacement == Carried::keep && particles_.x0.empty())
      particles_.x0 = particles_.x;
    // A fit has some hundred bytes: each is used at once, and none is kept.
    found_ = parallel_sum<Extremes>(body_.size(), [&](Index i) {
      const auto fit = cloud.fit(particles_.x[row(i)]);
      if (fit)
        return take(i, *fit);
      Extremes nothing;
      nothing.unknown = {1, particles_.id[row(i)]};
      return nothing;
    });
    found_.largest = ranks_.max(found_.largest), found_.change = ranks_.max(found_.change);
    found_.pore_apart = ranks_.max(found_.pore_apart), found_.pore_largest = ranks_.max(found_.pore_largest);
    for (PlacesFound* const found : {&found_.unknown, &found_.refused})
      *found = {ranks_.sum(found->count), ranks_.min(found->first)};
    const Real least = 1e-6 * found_.largest;  // of the largest stress: rounding in files of single precision
    if (material_.law().description().has_strength && found_.refused.count == 0)
      found_.outside = parallel_sum<std::int64_t>(body_.size(), [&](Index i) { return std::int64_t{yields(i) > least ? 1 : 0}; });
    found_.outside = ranks_.sum(found_.outside), found_.pulled = ranks_.sum(found_.pulled);
  }

  /// Whether every particle has its values and its law takes them; an error if not.
  bool taken_by_all()
  {
    const std::int64_t count = ranks_.sum(std::int64_t{body_.size()});
    if (found_.unknown.count > 0)
      errors_.add(start_.where, "table",
                  fmt::format("{} of the {} particles of body \"{}\" lie so far beside the points of {} that these seem to lie on one {}, "
                              "so that values there are not known; the first is at ({}): extend the table",
                              found_.unknown.count, count, spec_.name, file_.string(), D == 2 ? "line" : "plane",
                              place_of_particle(found_.unknown.first, body_, particles_, ranks_)));
    if (found_.refused.count > 0)
      errors_.add(spec_.where, "initial",
                  fmt::format("law \"{}\" does not take the stress of the table at {} of the {} particles of body \"{}\", the first at "
                              "({}): give a stress that it can have there",
                              material_.law().name(), found_.refused.count, count, spec_.name,
                              place_of_particle(found_.refused.first, body_, particles_, ranks_)));
    return found_.unknown.count == 0 && found_.refused.count == 0;
  }

  Extremes take(Index i, const LinearFit<D>& fit)
  {
    const auto at = [&](const auto& column) { return fit.at([&](Index k) { return column[static_cast<std::size_t>(k)]; }); };
    const auto vector_at = [&](const auto& column) {
      return fit.at([&](Index k) { return Vec<D>(Eigen::Map<const Vec<D>>(column[static_cast<std::size_t>(k)].data())); });
    };
    const std::size_t p = row(i);
    Extremes found;
    const Real u = points_.pore.empty() ? 0 : at(points_.pore);
    Sym3 stress = fit.at([&](Index k) { return Sym3(points_.stress[static_cast<std::size_t>(k)]); });
    if (taken_.adds_pore)
      stress = add_diagonal(stress, u);
    if (taken_.drops_pore)
      stress = add_diagonal(stress, -u);
    for (const auto& column : points_.history)
      for (const HistoryVariable& variable : material_.law().variables())
        if (variable.key == column.first)
          history_value(material_, variable, i) = fit.at_within([&](Index k) { return column.second[static_cast<std::size_t>(k)]; });
    if (!material_.prestress(i, unpack(stress))) {
      found.refused = {1, particles_.id[p]};
      return found;
    }
    found.largest = stress.norm();
    found.change = yields(i, stress);
    found.pulled = stress.head<3>().sum() > 0 ? 1 : 0;
    if (taken_.has_pore) {
      particles_.pore.set(p, u);
      stress = add_diagonal(stress, -u);
      compare_pore(p, u, found);
    }
    particles_.stress.set(p, stress);
    if (start_.displacement == Carried::keep)
      particles_.x0.set(p, particles_.x[p] - vector_at(points_.displacement));
    if (points_.velocity.empty())
      return found;
    particles_.v.set(p, vector_at(points_.velocity));
    Mat<D> L = Mat<D>::Zero();
    for (std::size_t k = 0; k < fit.point.size(); ++k)
      L += Eigen::Map<const Vec<D>>(points_.velocity[static_cast<std::size_t>(fit.point[k])].data()) * fit.slope[k].transpose();
    particles_.L.set(p, L);
    return found;
  }

  void compare_pore(std::size_t p, Real u, Extremes& found) const
  {
    if (!setup_.conditions.water.any())
      return;
    const PoreWater water{setup_.conditions.water, setup_.conditions.loads.gravity.table(0)};
    const Real here = water.pressure(mesh_, particles_.cell[p], Vec<D>(particles_.x[p]));
    found.pore_apart = std::abs(here - u);
    found.pore_largest = std::max(std::abs(here), std::abs(u));
  }

  /// By how much the law changes the stress that it takes, nothing moving [Pa].
  Real yields(Index i, const Sym3& stress) const
  {
    constexpr Real long_step = 1;  // s: laws that resist by their rate have returned by then
    if (!material_.law().description().has_strength)
      return 0;
    const Real* const mine = material_.history.row(i);
    std::vector<Real> history(mine, mine + material_.law().description().history_width);
    const Mat3 answer =
        material_.law().update(Increment{Mat3::Identity(), Mat3::Zero(), unpack(stress), long_step, 0, false}, history.data());
    return (pack(answer) - stress).norm();
  }
  Real yields(Index i) const
  {
    const std::size_t p = row(i);
    return yields(i, taken_.has_pore ? add_diagonal(Sym3(particles_.stress[p]), particles_.pore[p]) : Sym3(particles_.stress[p]));
  }

  void report(Real farthest)
  {
    constexpr Real worth_a_word = 0.01, most_pulled = 0.5;
    const std::int64_t count = ranks_.sum(std::int64_t{body_.size()});
    setup_.start_states.push_back({spec_.name, std::filesystem::absolute(file_).string(), static_cast<std::int64_t>(points_.x.size()),
                                   count, found_.outside, found_.largest > 0 ? found_.change / found_.largest : 0, farthest});
    const auto list = [](const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); };
    setup_.notes.push_back(
        fmt::format("body \"{}\": {} stress of {}, {} points{}; used {}{}; particles are at most {:.3g} m from the nearest point",
                    spec_.name, points_.is_effective ? "effective" : "total", start_.table, points_.x.size(),
                    points_.merged > 0 ? fmt::format(" ({} more lie on others and have their values)", points_.merged) : "",
                    list(points_.used), points_.unused.empty() ? "" : "; not used " + list(points_.unused), farthest));
    const auto warn = [&](const std::string& what) { setup_.warnings.push_back(fmt::format("{}: {}", to_string(start_.where), what)); };
    if (found_.outside > 0)
      warn(fmt::format(
          "the stress of {} of the {} particles of body \"{}\" lies beyond the yield surface of law \"{}\", by up to {:.3g} % of the "
          "largest stress; the first step that may yield returns it",
          found_.outside, count, spec_.name, material_.law().name(), 100 * found_.change / found_.largest));
    if (static_cast<Real>(found_.pulled) > most_pulled * static_cast<Real>(count) && scene_has_gravity())
      warn(
          fmt::format("{} of the {} particles of body \"{}\" are under tension: if the table has compression positive, give sign: "
                      "compression_positive",
                      found_.pulled, count, spec_.name));
    if (found_.pore_apart > worth_a_word * found_.pore_largest)
      warn(fmt::format(
          "the pore pressure of the table differs from that below the water table of the scene by up to {:.4g} Pa in body \"{}\": the "
          "effective stress is that of the table, and the pressure becomes that of the scene",
          found_.pore_apart, spec_.name));
  }
  bool scene_has_gravity() const { return !setup_.conditions.loads.gravity.acceleration.isZero(0); }

  const Scene& scene_;
  const BodySpec& spec_;
  const StartStateSpec& start_;
  const Mesh<D>& mesh_;
  Communicator& ranks_;
  SceneErrorCollector& errors_;
  Setup<D>& setup_;
  const Body& body_;
  Material& material_;
  Particles<D>& particles_;
  std::filesystem::path file_;
  StartPoints points_;
  StressTaken taken_;
  Extremes found_;
};

}  // namespace

template <int D>
void set_start_states(const Scene& scene, const Mesh<D>& mesh, Communicator& ranks, SceneErrorCollector& errors, Setup<D>& setup)
{
  for (const BodySpec& spec : scene.bodies) {
    const auto body = std::ranges::find(setup.state.bodies, spec.name, &Body::name);
    if (spec.initial && body != setup.state.bodies.end())
      StartOfBody<D>(scene, spec, static_cast<std::size_t>(body - setup.state.bodies.begin()), mesh, ranks, errors, setup).set();
  }
  if (setup.start_states.empty() || scene.stages.empty())
    return;
  if (const auto* stage = std::get_if<GeostaticSpec>(&scene.stages.front()); stage != nullptr && stage->ramp > 0)
    setup.warnings.push_back(
        fmt::format("{}: gravity grows from nothing (ramp) under bodies that carry their stress already; without ramp they stay at rest",
                    to_string(stage->where)));
}

template void set_start_states<2>(const Scene&, const Mesh<2>&, Communicator&, SceneErrorCollector&, Setup<2>&);
template void set_start_states<3>(const Scene&, const Mesh<3>&, Communicator&, SceneErrorCollector&, Setup<3>&);

}  // namespace talus
