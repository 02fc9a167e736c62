#pragma once
// A strip: the particles of a body in eight neighbouring cells, in one piece of memory.
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/strip_column.hpp"
#include "mesh/blocks.hpp"

namespace talus {

constexpr std::size_t to_size(Index i) noexcept { return static_cast<std::size_t>(i); }

inline constexpr Index strip_cells = 8, strips_in_block = block_cells / strip_cells;
static_assert(block_cells % strip_cells == 0);
/// Packs begin at any particle of a strip and so end up to three particles behind the last one; whole packs also pad the strip.
inline constexpr Index strip_padding = pack_size;

/// The first array of each column that a step uses; `none` without.
struct StepArrays {
  Index id, x, before, x0, v, F, stress, mass, volume0, volume, applied, volume_ratio, averaged, viscous, pore, water, water_gradient,
      water_at_rest, jump_stress, side, reference, since_reference, domain;
};

/// Where the columns of a strip stand: component c of the column at `x` is array x + c of the strip.  The cell follows from the place.
/// Where a kernel computes them cheaply, the velocity gradient and the affine field follow from the nodes and the position before the last
/// step, which has arrays of its own; otherwise they are arrays too.
class StripLayout {
 public:
  StripLayout() = default;
  /// The columns of particles that some rank has, see count_keepers().
  template <int D>
  StripLayout(const Particles<D>& particles, std::span<const std::int64_t> keepers, bool keeps_gradients)
      : keeps_gradients_(keeps_gradients)
  {
    std::size_t number = 0;
    particles.for_each_column([&](std::string_view name, std::string_view, const auto& column) {
      using Kind = std::decay_t<decltype(column)>;
      const bool is_gradient = name == gradient || name == affine;
      if (is_gradient && keepers[number] > 0)
        gradients_ += RowsOf<Kind>::components;
      has_affine_ |= name == affine && keepers[number] > 0;
      const bool has = keepers[number++] > 0 && name != "cell" && !is_gradient;
      at_.push_back(has ? width_ : none);
      names_.push_back(name);
      if (has)
        width_ += RowsOf<Kind>::components;
    });
    arrays_ = {.id = at("id"),
               .x = at("position"),
               .before = std::exchange(width_, width_ + D),
               .x0 = at("start"),
               .v = at("velocity"),
               .F = at("deformation_gradient"),
               .stress = at("stress"),
               .mass = at("mass"),
               .volume0 = at("volume0"),
               .volume = at("volume"),
               .applied = at("applied"),
               .volume_ratio = at("volume_ratio"),
               .averaged = at("volume_ratio") == none ? none : width_++,
               .viscous = at("viscous_pressure"),
               .pore = at("pore_pressure"),
               .water = at("water_pressure"),
               .water_gradient = at("water_gradient"),
               .water_at_rest = at("water_at_rest"),
               .jump_stress = at("jump_stress"),
               .side = at("side"),
               .reference = at("reference"),
               .since_reference = at("since_reference"),
               .domain = at("domain")};
  }
  static constexpr std::string_view gradient = "velocity_gradient", affine = "affine";
  /// Arrays of a strip, without gradients and those of its law.
  Index width() const noexcept { return width_; }
  /// Numbers of the gradients of a particle, and how many arrays of a strip they are: as many, or none.
  Index gradients() const noexcept { return gradients_; }
  Index kept_gradients() const noexcept { return keeps_gradients_ ? gradients_ : 0; }
  bool has_affine() const noexcept { return has_affine_; }
  const StepArrays& step_arrays() const noexcept { return arrays_; }
  /// The first array of the positions at which the kernel weighs.
  Index place() const noexcept { return arrays_.reference != none ? arrays_.reference : arrays_.x; }
  /// The first array of a column by its number in Particles, or by its name; `none` without.
  Index at(std::size_t number) const noexcept { return at_[number]; }
  Index at(std::string_view name) const noexcept
  {
    for (std::size_t number = 0; number < names_.size(); ++number)
      if (names_[number] == name)
        return at_[number];
    return none;
  }

 private:
  std::vector<Index> at_;
  std::vector<std::string_view> names_;
  Index width_ = 0, gradients_ = 0;
  StepArrays arrays_{};
  bool has_affine_ = false, keeps_gradients_ = false;
};

/// Memory that begins at a cache line.
struct FreeAligned {
  void operator()(Real* numbers) const noexcept { ::operator delete[](numbers, std::align_val_t{64}); }
};
using AlignedNumbers = std::unique_ptr<Real[], FreeAligned>;
inline AlignedNumbers allocate_aligned(std::size_t numbers)
{
  return AlignedNumbers(static_cast<Real*>(::operator new[](numbers * sizeof(Real), std::align_val_t{64})));
}

/// Memory of strips, used again when a strip has outgrown it or has become empty, so that a body that moves does not add memory.
class StripMemory {
 public:
  /// The contents are not defined.
  Real* take(std::size_t numbers)
  {
    const std::lock_guard guard(mutex_);
    if (std::vector<Real*>& free = free_[numbers]; !free.empty()) {
      Real* const first = free.back();
      free.pop_back();
      return first;
    }
    pieces_.push_back(allocate_aligned(numbers));
    numbers_ += numbers;
    return pieces_.back().get();
  }
  void give_back(Real* first, std::size_t numbers)
  {
    const std::lock_guard guard(mutex_);
    free_[numbers].push_back(first);
  }
  std::size_t bytes() const noexcept { return numbers_ * sizeof(Real); }

 private:
  std::mutex mutex_;
  std::map<std::size_t, std::vector<Real*>> free_;  ///< pieces by size
  std::vector<AlignedNumbers> pieces_;
  std::size_t numbers_ = 0;
};

/// Arrays of `room` numbers, one after the other: those of the layout, gradients that are kept, then those of the law.  Particles stand in
/// the order of cells and ids.
struct Strip {
  Real* numbers = nullptr;
  Index room = 0, n = 0;
  std::array<Index, strip_cells> count{};  ///< particles of each cell
  Index arrangement = 0;                   ///< counts the changes of its particles and of their references
  Real* loaded_gradients = nullptr;        ///< arrays of gradients before the first sweep

  Real* array(Index k) const noexcept { return numbers + static_cast<std::size_t>(k) * static_cast<std::size_t>(room); }
};
/// Room for n particles and some more, in whole cache lines.
constexpr Index room_for(Index n) noexcept { return (n + n / 8 + strip_padding + 7) / 8 * 8; }

/// The columns of a strip that a step uses.
template <int D>
struct StripColumns {
  StripColumn<Vec<D>> x{}, before{}, x0{}, v{};
  StripColumn<Mat<D>> L{}, C{};  ///< in the strip only where gradients are kept; C is empty where the affine field is L
  StripColumn<Mat3> F{};
  StripColumn<Sym3> stress{};
  StripColumn<Real> mass{}, volume0{}, volume{}, viscous{}, pore{}, water{}, water_at_rest{}, side{};
  StripColumn<Vec<D>> water_gradient{};          ///< of the pressure of water that flows [Pa/m]
  StripColumn<Mat<D>> jump_stress{};             ///< see JumpForces [Pa]
  StripColumn<Vec<D>> applied{};                 ///< forces of loads at the present positions [N]
  StripColumn<Real> volume_ratio{}, averaged{};  ///< of averaged volumes: see StressStrip; `averaged` lasts for a step
  StripColumn<Vec<D>> reference{};               ///< where there are reference configurations, see reference.hpp [m]
  StripColumn<Mat<D>> G{};
  StripColumn<Mat<D>> domain{};  ///< edges, where particles may be split [m]
  StripIds id{};
  const StripColumn<Mat<D>>& affine_field() const noexcept { return C ? C : L; }
  /// Where the kernel weighs the particles: the cells of strips hold these positions.
  const StripColumn<Vec<D>>& places() const noexcept { return reference ? reference : x; }
};

/// Particles that are to leave their cells, with copies of their numbers as in Arrival, one after the other.
struct Leavers {
  struct Leaver {
    Index strip, position;   ///< where it is in its block
    Index cell;              ///< where it is
    Index to = none;         ///< its new cell, at first the cell in which to look for it; `none`: not found, or it is deleted
    bool is_summed = false;  ///< it goes to a cell of the same block, whose sums contain it already
  };
  std::vector<Leaver> all;  ///< in the order of strips and positions
  std::vector<Real> numbers;
  void clear() noexcept { all.clear(), numbers.clear(); }
};
/// A particle that comes to a cell: its numbers in the order of the arrays, its gradients, then those of its law.
struct Arrival {
  Index cell;
  std::int64_t id;
  const Real* numbers;
  bool is_summed;  ///< see Leaver
};

}  // namespace talus
