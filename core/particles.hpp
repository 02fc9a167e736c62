#pragma once
// The particles of a run as a struct of arrays; each body is a contiguous range of rows.
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/particle_column.hpp"
#include "core/tensor.hpp"

namespace talus {

/// A body: rows [begin, end) of the particle arrays.
struct Body {
  std::string name;
  Index begin, end;
  SourceLocation where;  ///< position in the scene of the declaration of the body
  Index size() const noexcept { return end - begin; }
  static constexpr auto fields() { return std::tuple{saved("begin", &Body::begin), saved("end", &Body::end)}; }
};

/// All particles.  Columns of the second group are empty unless the scene needs them.  Positions and volumes are always stored in double
/// precision: a slow particle moves less in a step than the spacing of single precision, and in a stiff material rounding of the volume
/// causes pressure.  For the same reasons F is stored as its difference to I in single precision.
template <int D>
struct Particles {
  std::vector<std::int64_t> id;            ///< number that survives sorting and deletion of particles
  std::vector<Index> cell;                 ///< the cell that holds x
  Rows<Vec<D>> x;                          ///< position [m]
  ParticleColumn<Vec<D>> v;                ///< velocity [m/s]
  ParticleColumn<Mat<D>> L;                ///< velocity gradient [1/s]
  ParticleColumn<Mat3, Rest::identity> F;  ///< deformation gradient, plane strain in 2-D
  ParticleColumn<Sym3> stress;             ///< Cauchy stress [Pa], tension positive
  ParticleColumn<Real> mass;               ///< mass [kg]
  Rows<Real> volume0;                      ///< volume at the start [m^D, unit thickness in 2-D]
  Rows<Real> volume;                       ///< present volume, det F times volume0

  ParticleColumn<Mat<D>> C;        ///< affine velocity field, where it differs from L [1/s]
  Rows<Vec<D>> x0;                 ///< position from which the displacement counts [m]
  ParticleColumn<Vec<D>> applied;  ///< force of loads other than gravity [N]
  std::vector<Real> applied_at;    ///< applied . x before the move [J]
  Rows<Real> volume_ratio;         ///< bodies with averaged volumes: (averaged / own volume ratio)^(1/D)
  ParticleColumn<Real> viscous;    ///< artificial viscous pressure, part of `stress` [Pa]
  ParticleColumn<Real> pore;       ///< pore pressure, part of `stress`; 0 in bodies whose laws use total stress [Pa]

  Index size() const noexcept { return static_cast<Index>(id.size()); }
  const ParticleColumn<Mat<D>>& affine_fields() const noexcept { return C.empty() ? L : C; }

  Precision precision() const noexcept { return F.precision(); }
  void keep_in(Precision precision)
  {
    for_each_kind_of_column(
        *this, [](std::string_view, std::string_view, const auto&) {},
        [&](std::string_view, std::string_view, auto& column) { column.keep_in(precision); });
  }

  /// Calls f(name, unit, rows) for every column, including empty ones: for resizing, sorting and counting of bytes.
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
  /// Calls plain(name, unit, column) for columns of fixed precision, and the other function for those whose precision the scene chooses.
  template <class Self, class Plain, class Kept>
  static void for_each_kind_of_column(Self& self, Plain&& plain, Kept&& variable_precision)
  {
    plain("id", "-", self.id), plain("cell", "-", self.cell), plain("position", "m", self.x), variable_precision("velocity", "m/s", self.v),
        variable_precision("velocity_gradient", "1/s", self.L);
    variable_precision("deformation_gradient", "-", self.F), variable_precision("stress", "Pa", self.stress),
        variable_precision("mass", "kg", self.mass), plain("volume0", "m^D", self.volume0), plain("volume", "m^D", self.volume);
    variable_precision("affine", "1/s", self.C), plain("start", "m", self.x0), variable_precision("applied", "N", self.applied),
        plain("applied_at", "J", self.applied_at);
    plain("volume_ratio", "-", self.volume_ratio), variable_precision("viscous_pressure", "Pa", self.viscous),
        variable_precision("pore_pressure", "Pa", self.pore);
  }
};

}  // namespace talus
