#include "app/observers/moved_particles.hpp"

#include "app/observers/runout_distance.hpp"

namespace talus {

template <int D>
std::vector<MovedParticle<D>> gather_moved(const RunView<D>& view, const RunoutSpec& spec, Real least)
{
  const auto among = [](const std::vector<std::string>& names, const Body& body) {
    return std::find(names.begin(), names.end(), body.name) != names.end();
  };
  const Particles<D>& p = view.state.particles;
  std::vector<MovedParticle<D>> here;
  for (const Body& body : view.state.bodies) {
    if (!spec.bodies.empty() && !among(spec.bodies, body))
      continue;
    const std::int64_t eroded = among(spec.eroded, body) ? 1 : 0;
    for (auto row = static_cast<std::size_t>(body.begin); row < static_cast<std::size_t>(body.end); ++row) {
      const Vec3 then = in_space<D>(p.x0[row]), now = in_space<D>(p.x[row]);
      if ((now - then).norm() >= least)
        here.push_back({p.id[row],
                        eroded,
                        {then[0], then[1], then[2]},
                        {now[0], now[1], now[2]},
                        p.mass[row],
                        p.volume[row],
                        Vec<D>(p.v[row]).norm()});
    }
  }
  std::vector<MovedParticle<D>> all;
  for (const std::vector<MovedParticle<D>>& of_rank : gather_rows<MovedParticle<D>>(*view.problem.ranks, here))
    all.insert(all.end(), of_rank.begin(), of_rank.end());
  std::sort(all.begin(), all.end(), [](const MovedParticle<D>& a, const MovedParticle<D>& b) { return a.id < b.id; });
  return all;
}

template <int D>
void count_altogether(const std::vector<MovedParticle<D>>& moved, const Vec3& up, Real mass_share, RunoutNumbers& sums)
{
  std::vector<Vec3> then, now;
  std::vector<Real> masses, speeds;
  Vec3 moment = Vec3::Zero(), moment_then = Vec3::Zero();
  Real mass = 0, mass_times_speed = 0;
  sums.volume = sums.entrained = sums.kinetic = sums.fastest = 0;
  for (const MovedParticle<D>& p : moved) {
    then.push_back(p.then()), now.push_back(p.now()), masses.push_back(p.mass), speeds.push_back(p.speed);
    mass += p.mass, mass_times_speed += p.mass * p.speed;
    moment += p.mass * p.now(), moment_then += p.mass * p.then();
    sums.volume += p.volume;
    sums.entrained += p.eroded != 0 ? p.volume : 0;
    sums.kinetic += p.mass * p.speed * p.speed / 2;
    sums.fastest = std::max(sums.fastest, p.speed);
  }
  sums.mean_speed = mass > 0 ? mass_times_speed / mass : 0;
  sums.bulk = not_exceeded_by(speeds, masses, mass_share);
  const auto reach = reach_of(then, now, masses, up, mass_share);
  const Vec3 nowhere = Vec3::Constant(std::numeric_limits<Real>::quiet_NaN());
  sums.front = reach ? reach->front : nowhere;
  sums.height = reach ? reach->height : std::numeric_limits<Real>::quiet_NaN(),
  sums.length = reach ? reach->length : std::numeric_limits<Real>::quiet_NaN();
  sums.centre = reach ? Vec3(moment / mass) : nowhere;
  const Vec3 way = reach ? Vec3((moment - moment_then) / mass) : nowhere;
  sums.centre_height = 0 - way.dot(up), sums.centre_length = on_the_level(way, up).norm();
}

template std::vector<MovedParticle<2>> gather_moved<2>(const RunView<2>&, const RunoutSpec&, Real);
template std::vector<MovedParticle<3>> gather_moved<3>(const RunView<3>&, const RunoutSpec&, Real);
template void count_altogether<2>(const std::vector<MovedParticle<2>>&, const Vec3&, Real, RunoutNumbers&);
template void count_altogether<3>(const std::vector<MovedParticle<3>>&, const Vec3&, Real, RunoutNumbers&);

}  // namespace talus
