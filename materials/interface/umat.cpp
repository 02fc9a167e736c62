#include "materials/interface/umat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace talus {

namespace {

constexpr int tensor = 6;
/// Components of Talus in the order of Abaqus: 11, 22, 33, 12, 13, 23.
constexpr std::array<int, tensor> order{0, 1, 2, 3, 5, 4};
/// History of a particle: total strain, energies, then STATEV.
constexpr int energies = tensor, statev = tensor + 3;

/// The context of the law: what a call needs besides the particle.
struct Umat {
  UmatFunction function;
  std::string name, cmname;
  std::vector<double> props, start;
  std::optional<Real> bulk, shear;
  std::vector<std::string> keys;
  std::vector<talus_law_variable> variables;
  std::shared_ptr<const void> library;
};

/// One call: input and output of a material point.
struct UmatCall {
  std::array<double, tensor> stress{}, stran{}, dstran{}, ddsddt{}, drplde{};
  std::array<double, std::size_t{tensor} * tensor> ddsdde{};
  std::array<double, 3> energy{}, coords{};
  std::array<double, 2> time{};
  std::array<double, 9> drot{1, 0, 0, 0, 1, 0, 0, 0, 1}, dfgrd0 = drot, dfgrd1 = drot;
  std::vector<double> statev{};
  double dtime = 1, celent = 0, pnewdt = 1;
  int noel = 0;

  void run(const Umat& umat)
  {
    constexpr int ndi = 3, nshr = 3, ntens = tensor, one = 1;
    const double zero = 0;
    const auto nstatv = static_cast<int>(umat.start.size()), nprops = static_cast<int>(umat.props.size());
    const int kinc = time[1] == 0 ? 1 : 2;
    const std::array<int, 4> jstep{1, 0, 0, 0};
    double rpl = 0, drpldt = 0, none = 0;
    umat.function(stress.data(), statev.empty() ? &none : statev.data(), ddsdde.data(), &energy[0], &energy[1], &energy[2], &rpl,
                  ddsddt.data(), drplde.data(), &drpldt, stran.data(), dstran.data(), time.data(), &dtime, &zero, &zero, &zero, &zero,
                  umat.cmname.data(), &ndi, &nshr, &ntens, &nstatv, umat.props.empty() ? &zero : umat.props.data(), &nprops, coords.data(),
                  drot.data(), &pnewdt, &celent, dfgrd0.data(), dfgrd1.data(), &noel, &one, &one, &one, jstep.data(), &kinc,
                  umat.cmname.size());
  }
  /// The modulus of uniaxial strain and the shear modulus of DDSDDE [Pa], 0 where it has none.
  std::array<double, 2> moduli() const
  {
    const auto largest = [&](std::size_t from) {
      double most = 0;
      for (std::size_t i = from; i < from + 3; ++i)
        if (const double here = ddsdde[i * tensor + i]; std::isfinite(here))
          most = std::max(most, here);
      return most;
    };
    return {largest(0), largest(3)};
  }
};

int refuse(char* message, std::size_t size, std::string_view words)
{
  *fmt::format_to_n(message, size - 1, "{}", words).out = '\0';
  return 1;
}

int begin_umat(talus_law_setup* setup)
{
  const Umat& umat = *static_cast<const Umat*>(setup->context);
  std::ranges::copy(umat.start, setup->history + statev);
  if (umat.bulk) {
    setup->bulk = *umat.bulk, setup->shear = *umat.shear;
    return 0;
  }
  UmatCall call;
  call.statev = umat.start;
  call.run(umat);
  const auto [confined, shear] = call.moduli();
  setup->bulk = confined - 4 * shear / 3, setup->shear = shear;
  if (setup->bulk > 0)
    return 0;
  return refuse(setup->message, setup->message_size,
                fmt::format("DDSDDE at rest has the modulus of uniaxial strain {:.6g} Pa and the shear modulus {:.6g} Pa, from which no "
                            "time step follows: give bulk_modulus and shear_modulus",
                            confined, shear));
}

/// Component c of particle p.
template <class T>
T& at(const talus_law_block& block, T* array, int c, int p) noexcept
{
  return array[c * block.stride + p];
}

void read_particle(const talus_law_block& block, int p, UmatCall& call)
{
  for (int k = 0; k < tensor; ++k) {
    const int c = order[static_cast<std::size_t>(k)];
    const double engineering = k < 3 ? 1 : 2;
    const auto to = static_cast<std::size_t>(k);
    call.stress[to] = at(block, block.stress, c, p);
    call.stran[to] = engineering * at(block, block.history, c, p);
    call.dstran[to] = engineering * at(block, block.strain, c, p);
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {  // by columns
      const auto to = static_cast<std::size_t>(3 * j + i);
      call.drot[to] = at(block, block.rotation, 3 * i + j, p);
      call.dfgrd0[to] = at(block, block.F_old, 3 * i + j, p);
      call.dfgrd1[to] = at(block, block.F, 3 * i + j, p);
    }
  for (int k = 0; k < 3; ++k) {
    call.energy[static_cast<std::size_t>(k)] = at(block, block.history, energies + k, p);
    call.coords[static_cast<std::size_t>(k)] = at(block, block.position, k, p);
  }
  for (std::size_t k = 0; k < call.statev.size(); ++k)
    call.statev[k] = at(block, block.history, statev + static_cast<int>(k), p);
  call.time = {block.time - block.dt, block.time - block.dt};
  call.dtime = block.dt, call.celent = block.size[p], call.pnewdt = 1;
  call.noel = static_cast<int>(std::clamp<std::int64_t>(block.id[p] + 1, 0, std::numeric_limits<int>::max()));
  call.ddsdde.fill(0);
}

void write_particle(const UmatCall& call, const talus_law_block& block, int p)
{
  for (int k = 0; k < tensor; ++k) {
    const int c = order[static_cast<std::size_t>(k)];
    at(block, block.stress, c, p) = call.stress[static_cast<std::size_t>(k)];
    at(block, block.history, c, p) += at(block, block.strain, c, p);
  }
  for (int k = 0; k < 3; ++k)
    at(block, block.history, energies + k, p) = call.energy[static_cast<std::size_t>(k)];
  for (std::size_t k = 0; k < call.statev.size(); ++k)
    at(block, block.history, statev + static_cast<int>(k), p) = call.statev[k];
  const auto [confined, shear] = call.moduli();  // never below those at rest: DDSDDE can be that of plastic flow
  block.shear[p] = std::max(block.shear[p], shear);
  block.bulk[p] = std::max(block.bulk[p], confined - 4 * block.shear[p] / 3);
}

int update_umat(talus_law_block* block)
{
  const Umat& umat = *static_cast<const Umat*>(block->context);
  static thread_local UmatCall call;
  call.statev.resize(umat.start.size());
  int failed = -1;
  for (int p = 0; p < block->n; ++p) {
    read_particle(*block, p, call);
    call.run(umat);
    write_particle(call, *block, p);
    if (!(call.pnewdt < 1))
      continue;
    at(*block, block->stress, 0, p) = std::numeric_limits<double>::quiet_NaN();
    if (failed >= 0)
      continue;
    failed = p;
    refuse(block->message, block->message_size,
           fmt::format("it asks for a shorter time step, PNEWDT = {:.3g}, which Talus does not repeat: take a smaller time.cfl or "
                       "time.max_step",
                       call.pnewdt));
  }
  block->failed = failed;
  return failed < 0 ? 0 : 1;
}

void add_variable(Umat& umat, std::string key, const char* unit, const char* meaning, int components)
{
  umat.keys.push_back(std::move(key));
  umat.variables.push_back({umat.keys.back().c_str(), unit, meaning, components, components == tensor ? 1 : 0, 0});
}

}  // namespace

std::shared_ptr<const OwnLawCode> umat_code(UmatFunction function, const UmatLaw& spec, OwnLawOrigin origin)
{
  const auto umat = std::make_shared<Umat>();
  umat->function = function, umat->name = spec.symbol, umat->props = spec.constants;
  umat->bulk = spec.bulk_modulus, umat->shear = spec.shear_modulus;
  umat->cmname = spec.cmname;
  umat->cmname.resize(80, ' ');
  umat->start = spec.initial_statev;
  umat->start.resize(static_cast<std::size_t>(spec.depvar));
  umat->library = std::move(origin.keeper);
  umat->keys.reserve(static_cast<std::size_t>(spec.depvar) + 4);  // the texts must not move
  add_variable(*umat, "stran", "-", "STRAN: logarithmic strain increments, summed and turned with the material", tensor);
  add_variable(*umat, "sse", "J/m^3", "SSE, specific elastic strain energy", 1);
  add_variable(*umat, spec.dissipation ? "plastic_work" : "spd", "J/m^3", "SPD, specific plastic dissipation", 1);
  add_variable(*umat, "scd", "J/m^3", "SCD, specific creep dissipation", 1);
  for (Index k = 1; k <= spec.depvar; ++k)
    add_variable(*umat, fmt::format("sdv{}", k), "-", "state variable of the subroutine", 1);
  talus_law law{};
  law.version = TALUS_LAW_VERSION, law.measure = TALUS_LAW_STRAIN;
  law.name = umat->name.c_str(), law.summary = "a subroutine UMAT";
  law.n_variables = static_cast<std::int32_t>(umat->variables.size()), law.variables = umat->variables.data();
  law.context = umat.get();
  law.begin = begin_umat, law.update = update_umat;
  return std::make_shared<const OwnLawCode>(law, OwnLawOrigin{std::move(origin.library), std::move(origin.digest), umat});
}

}  // namespace talus
