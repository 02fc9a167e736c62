#include "app/setup/checks/kernel_choice.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace talus {

namespace {

/// Above this the benchmark of a uniform stress was measured; grids of equal cells have 0.
constexpr Real clearly_uneven = 0.02;
/// From this slenderness on a body is taken for one that may bend: beams, plates, towers.
constexpr Real slender = 4;

bool is_there_at_first(const Scene& scene, const BodySpec& body) { return presence_of(body.name, scene.stages).from == 0; }

bool keeps_reference(const BodySpec& body) { return body.reference && body.reference->update == ReferenceUpdate::never; }

bool has_gravity(const Scene& scene)
{
  return std::ranges::any_of(scene.loads, [](const LoadSpec& load) { return std::holds_alternative<GravitySpec>(load); });
}

/// The velocity of a body at the start, as the scene has it; zeros where it has none, and numbers in one form.
std::vector<std::string> velocity_in_words(const Scene& scene, const BodySpec& body)
{
  std::vector<std::string> words = body.velocity;
  words.resize(static_cast<std::size_t>(scene.dimension), "0");
  for (std::string& word : words) {
    char* end = nullptr;
    if (const Real number = std::strtod(word.c_str(), &end); !word.empty() && *end == 0)
      word = fmt::format("{}", number + 0);  // -0 is 0
  }
  return words;
}

/// Whether two bodies start with different velocities, so that they may meet.
bool bodies_may_meet(const Scene& scene)
{
  const BodySpec* first = nullptr;
  for (const BodySpec& body : scene.bodies)
    if (is_there_at_first(scene, body)) {
      if (first != nullptr && velocity_in_words(scene, body) != velocity_in_words(scene, *first))
        return true;
      first = first != nullptr ? first : &body;
    }
  return false;
}

/// The first slender body whose surface cuts cells, so that no mesh follows it; null if there is none.
const BodySpec* beam_that_cuts_cells(const Scene& scene, const KernelUse& use)
{
  for (std::size_t b = 0; b < scene.bodies.size() && b < use.slenderness.size(); ++b)
    if (const BodySpec& body = scene.bodies[b];
        body.shape && is_there_at_first(scene, body) && use.slenderness[b] >= slender && !keeps_reference(body))
      return &body;
  return nullptr;
}

}  // namespace

bool any_flows(const std::vector<Material>& at_first, const std::vector<std::vector<Material>>& later)
{
  const auto dissipates = [](const Material& one) { return one.law().description().scalar_variable("plastic_work").has_value(); };
  const auto one_dissipates = [&](const std::vector<Material>& laws) { return std::ranges::any_of(laws, dissipates); };
  return one_dissipates(at_first) || std::ranges::any_of(later, one_dissipates);
}

template <int D>
std::vector<Real> slenderness(const Particles<D>& particles, const std::vector<Body>& bodies)
{
  std::vector<Real> all;
  for (const Body& body : bodies) {
    Vec<D> centre = Vec<D>::Zero();
    Mat<D> moments = Mat<D>::Zero();
    for (Index row = body.begin; row < body.end; ++row)
      centre += particles.x[static_cast<std::size_t>(row)] / static_cast<Real>(body.end - body.begin);
    for (Index row = body.begin; row < body.end; ++row) {
      const Vec<D> arm = particles.x[static_cast<std::size_t>(row)] - centre;
      moments += arm * arm.transpose();
    }
    const Vec<D> sizes = Eigen::SelfAdjointEigenSolver<Mat<D>>().computeDirect(moments, Eigen::EigenvaluesOnly).eigenvalues();
    all.push_back(sizes[0] > 0 ? std::sqrt(sizes[D - 1] / sizes[0]) : 1);
  }
  return all;
}

template std::vector<Real> slenderness(const Particles<2>&, const std::vector<Body>&);
template std::vector<Real> slenderness(const Particles<3>&, const std::vector<Body>&);

std::vector<std::string> advice_on_kernel(const Scene& scene, const KernelUse& use)
{
  std::vector<std::string> advice;
  const TransferOptions& transfer = scene.transfer;
  const std::string_view scheme = enum_names(Scheme{})[static_cast<std::size_t>(transfer.scheme)];
  const bool estimates = scene.kernel == "umls" && (!scene.umls || scene.umls->gradient == UmlsGradient::estimate);
  if (scene.kernel == "linear" && use.moves && use.flows && !std::ranges::all_of(scene.bodies, keeps_reference))
    advice.emplace_back(
        "linear is for particles that stay in their cells: once they cross them its error grows on finer meshes "
        "(benchmarks/vibrating_bar at 2 m/s: 45 and 84 % with cells of 1 and 0.5 m, projected 1.3 and 0.5 %); leave `kernel` out");
  if (estimates && use.uneven_mesh > clearly_uneven)
    advice.emplace_back(
        "umls does not balance a uniform stress on uneven meshes (benchmarks/patch_test: error 7 to 11 % of it, projected 0.03 %); leave "
        "`kernel` out, or take umls: {gradient: exact_force} with aflip");
  if (use.flows && use.moves && has_gravity(scene) && !transfer.increments())
    advice.push_back(fmt::format(
        "{} loses energy in each step, so how far material runs depends on the length of the step; aflip loses it with time; leave "
        "`transfer.scheme` out and compare (benchmarks/column_collapse)",
        scheme));
  if (!use.flows && use.moves && bodies_may_meet(scene)) {
    if (transfer.scheme == Scheme::aflip && scene.kernel == "projected")
      advice.emplace_back(
          "aflip damps the vibration that an impact leaves (benchmarks/colliding_disks: 6 to 12 % of the energy, saflip 0.4 to 0.9 %); "
          "if it matters, take transfer: {scheme: saflip}");
    if (scene.contacts.empty())
      advice.emplace_back(
          "bodies without `contacts` share velocities and meet up to a cell and a half early (benchmarks/colliding_disks); with them they "
          "touch at their surfaces (benchmarks/contact)");
  }
  const bool averages = scene.kernel == "projected" && (!scene.projected || scene.projected->surfaces == AtSurfaces::plain);
  if (const BodySpec* body = beam_that_cuts_cells(scene, use);
      body != nullptr && averages && !use.flows && use.moves && !scene.loads.empty())
    advice.push_back(fmt::format(
        "the surface of body \"{}\" cuts cells, where projected is too soft in bending (benchmarks/cantilever); if it bends, let it fill a "
        "region of the mesh, or take kernel: umls with umls: {{gradient: exact_force}}",
        body->name));
  return advice;
}

}  // namespace talus
