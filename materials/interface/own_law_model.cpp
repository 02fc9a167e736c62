// Laws behind talus_law.h as the solver calls them.
#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cmath>
#include <exception>
#include <map>
#include <mutex>

#include "core/error.hpp"
#include "materials/interface/own_law_block.hpp"
#include "materials/interface/own_law_code.hpp"
#include "materials/interface/stress_pack.hpp"

namespace talus {

namespace {

using MessageText = std::array<char, 512>;

constexpr std::size_t most_threads = 1024;
std::array<std::atomic<const LawCall*>, most_threads> calls_of_threads;  // of those that have called a law

/// The call of a thread, which other threads can find while the thread exists.
class CallOfThread {
 public:
  CallOfThread() noexcept
  {
    for (auto& place : calls_of_threads) {
      const LawCall* nobody = nullptr;
      if (place.compare_exchange_strong(nobody, &now)) {
        place_ = &place;
        return;
      }
    }
  }
  ~CallOfThread()
  {
    if (place_ != nullptr)
      *place_ = nullptr;
  }
  CallOfThread(const CallOfThread&) = delete;
  CallOfThread& operator=(const CallOfThread&) = delete;

  LawCall now = {};

 private:
  std::atomic<const LawCall*>* place_ = nullptr;  // none for threads beyond the last place
};

thread_local CallOfThread call_of_thread;

constexpr int has_thrown = std::numeric_limits<int>::min();

/// Calls a function of the user, one thread at a time if it is `serial`.  Anything that it throws becomes a message and the result has_thrown.
template <class F>
int call_safely(const F& function, bool serial, const LawCall& call, MessageText& message) noexcept
{
  static std::mutex one_at_a_time;
  message.front() = '\0';
  int result = has_thrown;
  const auto say = [&](std::string_view words) { *fmt::format_to_n(message.data(), message.size() - 1, "{}", words).out = '\0'; };
  std::unique_lock guard(one_at_a_time, std::defer_lock);
  if (serial)
    guard.lock();
  call_of_thread.now = call;
  try {
    result = function();
  } catch (const std::exception& thrown) {
    say(thrown.what());
  } catch (...) {
    say("it has thrown an exception");
  }
  call_of_thread.now = {};
  message.back() = '\0';
  return result;
}

/// What particles without an answer have said at the last time at which there were any: the hundred with the lowest ids at most.
class Complaints {
 public:
  void add(Real time, std::int64_t id, std::string message)
  {
    constexpr std::size_t most = 100;
    const std::lock_guard guard(mutex_);
    if (time != std::exchange(time_, time))
      all_.clear();
    all_.insert_or_assign(id, std::move(message));
    if (all_.size() > most)
      all_.erase(std::prev(all_.end()));
  }
  std::string take(std::int64_t id)
  {
    const std::lock_guard guard(mutex_);
    const auto found = all_.find(id);
    std::string message = found == all_.end() ? std::string() : found->second;
    all_.clear();
    return message;
  }

 private:
  std::mutex mutex_;
  Real time_ = 0;
  std::map<std::int64_t, std::string> all_;
};

class OwnLaw final : public ConstitutiveLaw {
 public:
  OwnLaw(std::shared_ptr<const OwnLawCode> code, std::vector<Real> parameters, Real density, bool serial)
      : ConstitutiveLaw(code->description()),
        code_(std::move(code)),
        law_(code_->law()),
        density_(density),
        serial_(serial),
        parameters_(std::move(parameters)),
        constants_(static_cast<std::size_t>(law_.n_constants)),
        start_(static_cast<std::size_t>(description().history_width))
  {
    begin();
  }

  Real density() const noexcept override { return density_; }
  void initial_history(Real* history) const noexcept override { std::ranges::copy(start_, history); }

  Mat3 update(const Increment& step, Real* history) const noexcept override;
  StressSums update_stress(const Material& material, const StressStrip<2>& strip) const noexcept override
  {
    return update_strip(material, strip);
  }
  StressSums update_stress(const Material& material, const StressStrip<3>& strip) const noexcept override
  {
    return update_strip(material, strip);
  }

  Real wave_speed(const Mat3& F) const noexcept override { return std::sqrt(confined_ * F.determinant() / density_); }
  Real wave_speed(const Mat3& F, const Real*) const noexcept override { return wave_speed(F); }
  std::optional<Real> diffusivity() const noexcept override { return viscosity_ > 0 ? std::optional(viscosity_ / density_) : std::nullopt; }
  bool prestress(const Mat3& stress, Real* history) const noexcept override;
  std::shared_ptr<const ConstitutiveLaw> weakened(Real factor) const override;
  std::optional<Real> shear_modulus() const noexcept override { return shear_; }
  std::optional<HeatConduction> heat() const noexcept override { return std::nullopt; }
  std::optional<StrainAveraging> strain_averaging() const noexcept override { return std::nullopt; }
  std::string complaint(std::int64_t id) const override { return complaints_.take(id); }
  std::string library_digest() const override { return code_->origin().digest; }

 private:
  bool takes_strain() const noexcept { return law_.measure == TALUS_LAW_STRAIN; }
  void begin();
  /// Calls update() of the law for a block whose arrays are complete, but for moduli and messages.
  void call(talus_law_block& block, OwnLawBlock& arrays) const noexcept;
  template <int D>
  StressSums update_strip(const Material& material, const StressStrip<D>& strip) const noexcept;

  static OwnLawBlock& block_of_thread() noexcept
  {
    static thread_local OwnLawBlock block;
    return block;
  }

  std::shared_ptr<const OwnLawCode> code_;
  const talus_law& law_;
  Real density_;
  bool serial_;
  std::vector<Real> parameters_, constants_, start_;
  Real bulk_ = 0, shear_ = 0, viscosity_ = 0;
  Real confined_ = 0;  ///< modulus of uniaxial strain [Pa]
  mutable Complaints complaints_;
};

void OwnLaw::begin()
{
  for (std::size_t i = 0; i < description().variables.size(); ++i)
    std::fill_n(start_.begin() + description().variables[i].first, description().variables[i].components, law_.variables[i].start);
  MessageText message{};
  talus_law_setup setup{};
  setup.context = law_.context, setup.parameters = parameters_.data(), setup.density = density_;
  setup.constants = constants_.data(), setup.history = start_.data();
  setup.message = message.data(), setup.message_size = message.size();
  const int result = call_safely([&] { return law_.begin(&setup); }, serial_, {name().data()}, message);
  if (result != 0)
    throw Error(fmt::format("the law {} does not accept its parameters: {}", name(),
                            message.front() != '\0' ? std::string(message.data()) : fmt::format("begin() returned {}", result)));
  bulk_ = setup.bulk, shear_ = setup.shear, viscosity_ = setup.viscosity;
  confined_ = bulk_ + 4 * shear_ / 3;
  if (!(bulk_ > 0 && shear_ >= 0 && viscosity_ >= 0 && std::isfinite(confined_ + viscosity_)))
    throw Error(
        fmt::format("begin() of the law {} gave the bulk modulus {:.6g} Pa, the shear modulus {:.6g} Pa and the viscosity {:.6g} Pa s: "
                    "the first is positive, the others are not negative, all are finite",
                    name(), bulk_, shear_, viscosity_));
  if (!std::ranges::all_of(start_, [](Real x) { return std::isfinite(x); }))
    throw Error(fmt::format("the history of the law {} begins with a number that is not finite", name()));
}

void OwnLaw::call(talus_law_block& block, OwnLawBlock& arrays) const noexcept
{
  const auto n = static_cast<std::size_t>(block.n);
  std::fill_n(arrays.bulk().first, arrays.stride(), bulk_);
  std::fill_n(arrays.shear().first, arrays.stride(), shear_);
  MessageText message;
  block.failed = -1;
  block.density = density_, block.context = law_.context, block.parameters = parameters_.data(), block.constants = constants_.data();
  block.message = message.data(), block.message_size = message.size();
  const LawCall now{name().data(), arrays.id()[0], arrays.id()[n - 1], block.time};
  const int result = call_safely([&] { return law_.update(&block); }, serial_, now, message);
  if (result == 0)
    return;
  const bool known = result != has_thrown && 0 <= block.failed && block.failed < block.n;
  const auto failed = static_cast<std::size_t>(known ? block.failed : 0);
  for (std::size_t i = known ? failed : 0; i < (known ? failed + 1 : n); ++i)
    arrays.stress().component(0)[i] = std::numeric_limits<Real>::quiet_NaN();
  std::string words = message.front() != '\0' ? std::string(message.data()) : fmt::format("update() returned {}", result);
  for (std::size_t i = known ? failed : 0; i < (known ? failed + 1 : n); ++i)
    complaints_.add(block.time, arrays.id()[i], words);
}

Mat3 OwnLaw::update(const Increment& step, Real* history) const noexcept
{
  const Mat3 f = Mat3::Identity() + step.dt * step.L;
  if (!(step.F.determinant() > 0 && f.determinant() > 0))
    return no_answer();
  if (takes_strain() && step.dt == 0)  // nothing moves on, and a law may divide by the length of the step
    return step.stress;
  OwnLawBlock& arrays = block_of_thread();
  arrays.open(pack_size, takes_strain());
  const auto width = static_cast<std::size_t>(description().history_width);
  std::vector<Real> columns(std::max<std::size_t>(width, 1) * pack_size);
  for (std::size_t k = 0; k < width; ++k)
    std::fill_n(columns.begin() + static_cast<std::ptrdiff_t>(k * pack_size), pack_size, history[k]);
  const StripColumn<Real> of_law{columns.data(), pack_size};
  const Mat3 before = f.inverse() * step.F;
  const auto lanes = [](const Mat3& a) { return Mat3Of<SimdReal>(a.cast<SimdReal>()); };
  arrays.set_step(0, {lanes(before), lanes(step.F), lanes(step.L), lanes(step.stress), step.dt}, of_law, code_->turning());
  arrays.size().first[0] = 0, arrays.id()[0] = -1;
  arrays.position().set(0, Vec3::Zero());
  talus_law_block block = arrays.arrays(1, of_law);
  block.dimension = 3, block.elastic = step.elastic ? 1 : 0, block.time = step.time, block.dt = step.dt;
  call(block, arrays);
  for (std::size_t k = 0; k < width; ++k)
    history[k] = columns[k * pack_size];
  const Sym3 stress = arrays.stress().of(0);
  return unpack(stress);
}

template <int D>
StressSums OwnLaw::update_strip(const Material& material, const StressStrip<D>& strip) const noexcept
{
  OwnLawBlock& arrays = block_of_thread();
  arrays.open(std::max(strip.history.stride, static_cast<std::size_t>(padded(static_cast<int>(strip.n)))), takes_strain());
  struct Pack {
    MatOf<D> rate;
    Sym3Of<SimdReal> stored;
    SimdReal J, volume_before, shrinking, stretched;  // the last: det F as the law sees it
    detail::StepPressures pressures;
  };
  static thread_local std::vector<Pack> packs;  // in their order
  packs.clear();
  for (std::size_t i = 0; i < strip.n; i += pack_size) {
    Mat3Of<SimdReal> before = strip.F.load(i);
    if (material.averages_volume)
      before = detail::scaled_in_plane<D>(before, strip.volume_ratio.load(i));
    Pack& found = packs.emplace_back();
    found.rate = strip.L.load(i), found.stored = strip.stress.load(i), found.volume_before = strip.volume.load(i);
    found.shrinking = max(-SimdReal(found.rate.trace()), 0);
    Mat3Of<SimdReal> F = detail::move(strip, i, found.rate), L = embed(found.rate), stress = unpack(found.stored);
    found.J = F.determinant();
    detail::take_volume(strip, i, found.J);
    if (material.averages_volume)
      detail::average_volume(strip, i, found.J, F, L);
    found.stretched = F.determinant();
    const SimdReal speed = sqrt(SimdReal(confined_ * found.stretched / density_));
    found.pressures = detail::find_pressures(material, strip, i, found.shrinking, speed, stress);
    arrays.set_step(i, {before, F, L, stress, strip.dt}, strip.history, code_->turning());
  }
  for (std::size_t i = 0; i < strip.n; ++i) {
    arrays.id()[i] = strip.id[i];
    Vec3 x = Vec3::Zero();
    if (strip.x)
      x.head<D>() = strip.x.of(i);
    arrays.position().set(i, x);
  }
  std::copy_n(strip.altitude.first, strip.n, arrays.size().first);
  talus_law_block block = arrays.arrays(strip.n, strip.history);
  block.dimension = D, block.elastic = strip.elastic ? 1 : 0, block.time = strip.time, block.dt = strip.dt;
  call(block, arrays);
  detail::StressLanes lanes;
  for (std::size_t k = 0; k < packs.size(); ++k) {
    const std::size_t i = k * pack_size;
    const Pack& found = packs[k];
    const SimdReal modulus = arrays.bulk().load(i) + (4.0 / 3) * arrays.shear().load(i);
    const auto bounds_step = modulus > 0 && isfinite(modulus);
    if (!all_of(bounds_step))
      for (int lane = 0; lane < detail::lanes_of(strip, i); ++lane)
        if (!bounds_step[lane])
          complaints_.add(
              strip.time, strip.id[i + static_cast<std::size_t>(lane)],
              fmt::format("it gave the modulus of uniaxial strain {:.6g} Pa (bulk + 4/3 shear), from which no time step follows",
                          modulus[lane]));
    Sym3Of<SimdReal> stress = arrays.stress().load(i);
    stress[0] = where(found.J > 0 && bounds_step, stress[0], std::numeric_limits<Real>::quiet_NaN());
    stress = add_diagonal(stress, -(found.pressures.viscous + found.pressures.pore));
    const auto sound = detail::take_stress(strip, i, found.J, stress);
    const SimdReal work = detail::work_of(strip, i, found.rate, found.stored, found.volume_before, stress);
    const SimdReal speed = sqrt(SimdReal(modulus * found.stretched / density_));
    detail::count(material, strip, i, sound, work, speed, found.shrinking, diffusivity(), lanes);
  }
  return lanes.total();
}

bool OwnLaw::prestress(const Mat3& stress, Real* history) const noexcept
{
  if (!description().starts_from_stress)
    return false;
  if (law_.prestress == nullptr)
    return true;
  const Sym3 packed = pack(stress);
  std::vector<Real> own(history, history + description().history_width);  // a law that refuses changes nothing
  MessageText message;
  const int result =
      call_safely([&] { return law_.prestress(law_.context, parameters_.data(), constants_.data(), packed.data(), own.data()); }, serial_,
                  {name().data()}, message);
  if (result == 0)
    std::ranges::copy(own, history);
  return result == 0;
}

std::shared_ptr<const ConstitutiveLaw> OwnLaw::weakened(Real factor) const
{
  return law_.weaken == nullptr ? nullptr : own_law(code_, weakened_values(*code_, parameters_, factor), density_, serial_);
}

}  // namespace

std::vector<Real> weakened_values(const OwnLawCode& code, std::vector<Real> values, Real factor)
{
  MessageText message;
  const int result = call_safely([&] { return code.law().weaken(code.law().context, factor, values.data()); }, true,
                                 {code.description().name.data()}, message);
  if (result != 0)
    throw Error(fmt::format("the law {} cannot divide its strength by {:.6g}{}{}", code.description().name, factor,
                            message.front() != '\0' ? ": " : "", message.data()));
  if (const auto wrong = beyond_limits(code, values))
    throw Error(fmt::format("the law {} divides its strength by {:.6g}: {}", code.description().name, factor, *wrong));
  return values;
}

std::shared_ptr<const ConstitutiveLaw> own_law(std::shared_ptr<const OwnLawCode> code, std::vector<Real> parameters, Real density,
                                               bool serial)
{
  return std::make_shared<const OwnLaw>(std::move(code), std::move(parameters), density, serial);
}

const talus_law& described_law(const talus_law* (*describe)(), const std::string& name)
{
  const talus_law* law = nullptr;
  MessageText message;
  const int result = call_safely([&] { return law = describe(), 0; }, true, {name.c_str()}, message);
  if (result != 0)
    throw Error(fmt::format("{} failed: {}", name, message.data()));
  if (law == nullptr)
    throw Error(fmt::format("{} returned no law", name));
  return *law;
}

const LawCall& law_call_of_thread() noexcept { return call_of_thread.now; }

const LawCall& law_call_of_any_thread() noexcept
{
  if (call_of_thread.now.law != nullptr)
    return call_of_thread.now;
  for (const auto& place : calls_of_threads)
    if (const LawCall* const call = place.load(); call != nullptr && call->law != nullptr)
      return *call;
  return call_of_thread.now;
}

}  // namespace talus
