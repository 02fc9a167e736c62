#pragma once
// One law and its history over the particles of one body, and the questions a solver asks without knowing which law it is.
#include <optional>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "core/huge_page_allocator.hpp"
#include "materials/laws.hpp"

namespace talus {

/// Particles [begin, end) of the model follow `law`.  Every index i below counts from 0 inside the body.
template <class L>
struct Batch {
  static_assert(Law<L>);
  using LawType = L;
  using State = typename L::State;

  L law{};
  typename L::Constants constants{};  ///< of `law`: to be renewed when its parameters change
  Index begin{}, end{};
  Rows<State> history{};
  SourceLocation where{};
  std::string name{};
  std::optional<BulkViscosity> viscosity{};
  bool averages_volume = false;  ///< F-bar through nodes
  Index averages_with = none;    ///< F-bar: bodies of the same number are averaged as one; `none`: the body alone
  Rows<State> scratch{};         ///< of permute()

  Index size() const noexcept { return end - begin; }
  /// Cauchy stress [Pa] of particle i at the end of the step; changes its history.
  Mat3 update(Index i, const Increment& in) noexcept { return law.update(in, history[static_cast<std::size_t>(i)], constants); }
  /// The same of several particles, one per lane; those beyond `count` repeat the last one and are not changed.  Where the law is not
  /// written for lanes, one after the other.
  Mat3Of<SimdReal> update(const Index (&i)[pack_size], int count, const IncrementOf<SimdReal>& in) noexcept
  {
    StateRows<State> rows{{}, count};
    for (int lane = 0; lane < pack_size; ++lane)
      rows.row[lane] = &history[static_cast<std::size_t>(i[lane])];
    if constexpr (LawInLanes<L>)
      return law.update(in, rows, constants);
    else
      return update_one_by_one(law, in, rows, constants);
  }
  /// Upper bound of the speed of sound [m/s] in particle i, deformed by F.
  Real wave_speed(Index i, const Mat3& F) const noexcept
  {
    if constexpr (requires { law.wave_speed(F, history.front(), constants); })
      return law.wave_speed(F, history[static_cast<std::size_t>(i)], constants);
    else
      return law.wave_speed(F, constants);
  }
  SimdReal wave_speed(const Index (&i)[pack_size], int count, const Mat3Of<SimdReal>& F) const noexcept
  {
    if constexpr (LawInLanes<L>) {
      return law.wave_speed(F, constants);
    } else {
      SimdReal speed = 1;
      for (int lane = 0; lane < count; ++lane)
        speed.set(lane, wave_speed(i[lane], lane_of(F, lane)));
      return speed;
    }
  }
};

/// Makes it that of particles [begin, end) at rest: history as a particle starts with it.
template <class L>
void begin_anew(Index begin, Index end, Batch<L>& batch)
{
  batch.begin = begin, batch.end = end;
  if constexpr (requires { batch.law.initial_state(); })
    batch.history.assign(static_cast<std::size_t>(batch.size()), batch.law.initial_state());
  else
    batch.history.assign(static_cast<std::size_t>(batch.size()), {});
}

/// A body at rest.
template <class L>
Batch<L> make_batch(L law, Index begin, Index end, std::string name, SourceLocation where = {})
{
  const auto constants = law.constants();
  Batch<L> batch{.law = std::move(law), .constants = constants, .where = std::move(where), .name = std::move(name)};
  begin_anew(begin, end, batch);
  return batch;
}

namespace detail {
template <class L>
constexpr auto kinds_of()
{
  if constexpr (requires { typename L::Kinds; })
    return typename L::Kinds{};
  else
    return TypeList<L>{};
}
template <class... L>
constexpr auto all_kinds(TypeList<L...>)
{
  return joined(kinds_of<L>()...);
}
}  // namespace detail

/// The laws of the list, each in all its kinds.
using AnyBatch = variant_of<decltype(detail::all_kinds(Laws{})), Batch>;

/// The batch of a law as a scene gives it, of the kind that its parameters ask for.
template <class L>
AnyBatch make_any_batch(const L& law, Index begin, Index end, const std::string& name, const SourceLocation& where = {})
{
  if constexpr (requires { law.kind(); })
    return std::visit([&](const auto& kind) { return AnyBatch(make_batch(kind, begin, end, name, where)); }, law.kind());
  else
    return make_batch(law, begin, end, name, where);
}

inline void begin_anew(Index begin, Index end, AnyBatch& batch)
{
  std::visit([&](auto& typed) { begin_anew(begin, end, typed); }, batch);
}

/// One history variable of all particles of a body: column[i] is a Real or a Sym3.
template <class State, class Value>
struct HistoryColumn {
  State* first;
  Value State::*member;
  Index count;
  static constexpr int components = std::is_same_v<Value, Real> ? 1 : static_cast<int>(sizeof(Value) / sizeof(Real));

  Index size() const noexcept { return count; }
  auto& operator[](Index i) const noexcept { return first[i].*member; }
  /// Component c of particle i, whatever the type of the variable.
  auto& component(Index i, int c) const noexcept
  {
    if constexpr (components == 1)
      return (*this)[i];
    else
      return (*this)[i][c];
  }
};

/// f(key, unit, meaning, column) for every history variable in order of declaration; columns write through unless the batch is const.
template <class B, class F>
requires requires { typename std::remove_const_t<B>::LawType; }
void for_each_history(B& batch, F&& f)
{
  using State = typename B::State;
  using Row = std::conditional_t<std::is_const_v<B>, const State, State>;
  const auto count = static_cast<Index>(batch.history.size());
  for_each_field<State>([&]<class Owner, class Value>(const History<Owner, Value>& field) {
    f(field.key, field.unit, field.meaning, HistoryColumn<Row, Value>{batch.history.data(), field.member, count});
  });
}
template <class F>
void for_each_history(AnyBatch& batch, F&& f)
{
  std::visit([&](auto& typed) { for_each_history(typed, f); }, batch);
}
template <class F>
void for_each_history(const AnyBatch& batch, F&& f)
{
  std::visit([&](const auto& typed) { for_each_history(typed, f); }, batch);
}

/// Re-orders the history: afterwards particle i is the former particle order[i].  Allocates at its first call only.
void permute(AnyBatch& batch, std::span<const Index> order);

/// Makes `stress` [Pa] the stress of particle i at F = I.  False if the law cannot start from a stress.
template <class L>
bool prestress(Batch<L>& batch, Index i, const Mat3& stress) noexcept
{
  auto& state = batch.history[static_cast<std::size_t>(i)];
  if constexpr (requires { batch.law.prestress(stress, state); }) {
    batch.law.prestress(stress, state);
    return true;
  }
  return false;
}
bool prestress(AnyBatch& batch, Index i, const Mat3& stress) noexcept;

/// Energy [J] dissipated so far in particle i of a body, whose volume was `volume0` [m^3].  0 for a law without "plastic_work".
Real plastic_work(const AnyBatch& batch, Index i, Real volume0);

Real density(const AnyBatch& batch) noexcept;
Real wave_speed(const AnyBatch& batch, const Mat3& F) noexcept;
bool averages_volume(const AnyBatch& batch) noexcept;
Index averages_with(const AnyBatch& batch) noexcept;  ///< `none` as well where the body does not average
bool has_bulk_viscosity(const AnyBatch& batch) noexcept;
bool conducts_heat(const AnyBatch& batch) noexcept;
std::string_view law_name(const AnyBatch& batch) noexcept;

}  // namespace talus
