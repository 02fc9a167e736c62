#pragma once
// The particles of a run as a struct of arrays; bodies are contiguous ranges of it.
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/particle_column.hpp"
#include "core/tensor.hpp"

namespace talus {

/// Rows [begin, end) of the particle arrays.
struct Body {
  std::string name;
  Index begin, end;
  SourceLocation where;  ///< the scene line that made it
  Index size() const noexcept { return end - begin; }
  static constexpr auto fields() { return std::tuple{saved("begin", &Body::begin), saved("end", &Body::end)}; }
};

/// All particles.  The columns in the second group are empty unless the scene needs them.  Places and volumes stay in double whatever the
/// rest is kept in: a slow particle moves less in a step than a coordinate can tell in single precision, and a stiff volume answers a rounding
/// with pressure.  F is kept as its difference to I then, for the same reasons.
template <int D>
struct Particles {
  std::vector<std::int64_t> id;            ///< survives sorting and deletion
  std::vector<Index> cell;                 ///< the cell that holds x
  Rows<Vec<D>> x;                          ///< position [m]
  ParticleColumn<Vec<D>> v;                ///< velocity [m/s]
  ParticleColumn<Mat<D>> L;                ///< velocity gradient [1/s]
  ParticleColumn<Mat3, Rest::identity> F;  ///< deformation gradient, plane strain in 2-D
  ParticleColumn<Sym3> stress;             ///< Cauchy stress [Pa], tension positive
  ParticleColumn<Real> mass;               ///< [kg]
  Rows<Real> volume0;                      ///< volume at the start [m^D, unit thickness in 2-D]
  Rows<Real> volume;                       ///< det F times volume0

  ParticleColumn<Mat<D>> C;        ///< affine field, where it is not L [1/s]
  Rows<Vec<D>> x0;                 ///< where displacement counts from [m]
  ParticleColumn<Vec<D>> applied;  ///< force of loads other than gravity [N]
  std::vector<Real> applied_at;    ///< applied . x before the move [J]
  Rows<Real> volume_ratio;         ///< of a body that averages its volume: (averaged / own volume ratio)^(1/D)
  ParticleColumn<Real> viscous;    ///< artificial viscous pressure, part of `stress` [Pa]
  ParticleColumn<Real> pore;       ///< pore pressure, part of `stress`; 0 in bodies whose laws see total stress [Pa]

  Index size() const noexcept { return static_cast<Index>(id.size()); }
  const ParticleColumn<Mat<D>>& affine_fields() const noexcept { return C.empty() ? L : C; }

  Precision precision() const noexcept { return F.precision(); }
  void keep_in(Precision precision)
  {
    for_each_kind_of_column(
        *this, [](std::string_view, std::string_view, const auto&) {},
        [&](std::string_view, std::string_view, auto& column) { column.keep_in(precision); });
  }

  /// f(name, unit, rows) for every column, empty ones too: resizing, sorting, bytes per particle.
  template <class F_>
  void for_each_column(F_&& f)
  {
    for_each_kind_of_column(*this, f, [&](std::string_view name, std::string_view unit, auto& column) {
      column.visit([&](auto& rows) { f(name, unit, rows); });
    });
  }
  template <class F_>
  void for_each_column(F_&& f) const
  {
    for_each_kind_of_column(*this, f, [&](std::string_view name, std::string_view unit, const auto& column) {
      column.visit([&](const auto& rows) { f(name, unit, rows); });
    });
  }

 private:
  /// plain(name, unit, column) for columns that are always kept alike, kept(...) for those that the precision concerns.
  template <class Self, class Plain, class Kept>
  static void for_each_kind_of_column(Self& self, Plain&& plain, Kept&& saved)
  {
    plain("id", "-", self.id), plain("cell", "-", self.cell), plain("position", "m", self.x), saved("velocity", "m/s", self.v),
        saved("velocity_gradient", "1/s", self.L);
    saved("deformation_gradient", "-", self.F), saved("stress", "Pa", self.stress), saved("mass", "kg", self.mass),
        plain("volume0", "m^D", self.volume0), plain("volume", "m^D", self.volume);
    saved("affine", "1/s", self.C), plain("start", "m", self.x0), saved("applied", "N", self.applied),
        plain("applied_at", "J", self.applied_at);
    plain("volume_ratio", "-", self.volume_ratio), saved("viscous_pressure", "Pa", self.viscous), saved("pore_pressure", "Pa", self.pore);
  }
};

}  // namespace talus
