#pragma once
// The particles of a run as a struct of arrays; bodies are contiguous ranges of it.
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/tensor.hpp"

namespace talus {

/// Rows [begin, end) of the particle arrays.
struct Body {
  std::string name;
  Index begin, end;
  Where where;  ///< the scene line that made it
  Index size() const noexcept { return end - begin; }
};

/// All particles.  The columns in the second group are empty unless the scene needs them.
template <int D>
struct Particles {
  std::vector<std::int64_t> id;     ///< survives sorting and deletion
  std::vector<Index> cell;          ///< the cell that holds x
  std::vector<Vec<D>> x, v;         ///< position [m], velocity [m/s]
  std::vector<Mat<D>> L;            ///< velocity gradient [1/s]
  std::vector<Mat3> F;              ///< deformation gradient, plane strain in 2-D
  std::vector<Sym3> stress;         ///< Cauchy stress [Pa], tension positive
  std::vector<Real> mass, volume0;  ///< mass [kg], volume at the start [m^D, unit thickness in 2-D]
  std::vector<Real> volume;         ///< det F times volume0

  std::vector<Mat<D>> C;           ///< affine field, where it is not L [1/s]
  std::vector<Vec<D>> x0;          ///< where displacement counts from [m]
  std::vector<Vec<D>> applied;     ///< force of loads other than gravity [N]
  std::vector<Real> applied_at;    ///< applied . x before the move [J]
  std::vector<Real> volume_ratio;  ///< of a body that averages its volume: (averaged / own volume ratio)^(1/D)
  std::vector<Real> viscous;       ///< artificial viscous pressure, part of `stress` [Pa]

  Index size() const noexcept { return static_cast<Index>(id.size()); }
  const std::vector<Mat<D>>& affine_fields() const noexcept { return C.empty() ? L : C; }

  /// f(name, unit, column) for every column, empty ones too: resizing, sorting, bytes per particle.
  template <class F_>
  void for_each_column(F_&& f)
  {
    each(*this, f);
  }
  template <class F_>
  void for_each_column(F_&& f) const
  {
    each(*this, f);
  }

 private:
  template <class Self, class F_>
  static void each(Self& self, F_&& f)
  {
    f("id", "-", self.id), f("cell", "-", self.cell), f("position", "m", self.x), f("velocity", "m/s", self.v),
        f("velocity_gradient", "1/s", self.L);
    f("deformation_gradient", "-", self.F), f("stress", "Pa", self.stress), f("mass", "kg", self.mass), f("volume0", "m^D", self.volume0),
        f("volume", "m^D", self.volume);
    f("affine", "1/s", self.C), f("start", "m", self.x0), f("applied", "N", self.applied), f("applied_at", "J", self.applied_at);
    f("volume_ratio", "-", self.volume_ratio), f("viscous_pressure", "Pa", self.viscous);
  }
};

}  // namespace talus
