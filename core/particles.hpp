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

/// All particles.  Columns of the second group are empty unless the scene needs them.
template <int D>
struct Particles {
  std::vector<std::int64_t> id;  ///< number that survives sorting and deletion of particles
  std::vector<Index> cell;       ///< the cell that holds x, or the reference position where there is one
  ParticleColumn<Vec<D>> x;      ///< position [m]
  ParticleColumn<Vec<D>> v;      ///< velocity [m/s]
  ParticleColumn<Mat<D>> L;      ///< velocity gradient [1/s]
  ParticleColumn<Mat3> F;        ///< deformation gradient, plane strain in 2-D
  ParticleColumn<Sym3> stress;   ///< Cauchy stress [Pa], tension positive
  ParticleColumn<Real> mass;     ///< mass [kg]
  ParticleColumn<Real> volume0;  ///< volume at the start [m^D, unit thickness in 2-D]
  ParticleColumn<Real> volume;   ///< present volume, det F times volume0

  ParticleColumn<Mat<D>> C;               ///< affine velocity field, where it differs from L [1/s]
  ParticleColumn<Vec<D>> x0;              ///< position from which the displacement counts [m]
  ParticleColumn<Vec<D>> applied;         ///< force of loads other than gravity [N]
  ParticleColumn<Real> volume_ratio;      ///< bodies with averaged volumes: (averaged / own volume ratio)^(1/D)
  ParticleColumn<Real> viscous;           ///< artificial viscous pressure, part of `stress` [Pa]
  ParticleColumn<Real> pore;              ///< pore pressure, part of `stress`; 0 in bodies whose laws use total stress [Pa]
  ParticleColumn<Real> water;             ///< pressure of water that flows, of which `pore` is the part of `stress` [Pa]
  ParticleColumn<Vec<D>> water_gradient;  ///< its gradient, see PorePressure [Pa/m]
  ParticleColumn<Real> water_at_rest;     ///< what it would be below the water table of the scene, at rest [Pa]
  ParticleColumn<Mat<D>> jump_stress;     ///< against displacements that averaged gradients do not see, see JumpForces [Pa]
  ParticleColumn<Real> side;              ///< of the nearest sheet, see SideOfSheet [-]
  ParticleColumn<Vec<D>> reference;       ///< position at which the kernel weighs, where that is not always x [m]
  ParticleColumn<Mat<D>> G;               ///< deformation gradient since the particle was there
  ParticleColumn<Mat<D>> domain;          ///< edges of what the particle covers, the columns, where it may be split [m]

  Index size() const noexcept { return static_cast<Index>(id.size()); }

  /// Calls f(name, unit, column) for every column, including empty ones: for resizing, sorting and counting of bytes.  A column is a
  /// ParticleColumn or an array of numbers; particle_column.hpp has functions for both.
  template <class F_>
  void for_each_column(F_&& f)
  {
    for_each_column_of(*this, f);
  }
  template <class F_>
  void for_each_column(F_&& f) const
  {
    for_each_column_of(*this, f);
  }

 private:
  template <class Self, class F_>
  static void for_each_column_of(Self& self, F_&& f)
  {
    f("id", "-", self.id), f("cell", "-", self.cell), f("position", "m", self.x), f("velocity", "m/s", self.v);
    f("velocity_gradient", "1/s", self.L), f("deformation_gradient", "-", self.F), f("stress", "Pa", self.stress);
    f("mass", "kg", self.mass), f("volume0", "m^D", self.volume0), f("volume", "m^D", self.volume);
    f("affine", "1/s", self.C), f("start", "m", self.x0), f("applied", "N", self.applied);
    f("volume_ratio", "-", self.volume_ratio), f("viscous_pressure", "Pa", self.viscous), f("pore_pressure", "Pa", self.pore);
    f("water_pressure", "Pa", self.water), f("water_gradient", "Pa/m", self.water_gradient);
    f("water_at_rest", "Pa", self.water_at_rest);
    f("jump_stress", "Pa", self.jump_stress);
    f("side", "-", self.side), f("reference", "m", self.reference), f("since_reference", "-", self.G);
    f("domain", "m", self.domain);
  }
};

/// The memory of all columns [B].
template <int D>
std::size_t bytes_of(const Particles<D>& particles) noexcept
{
  std::size_t bytes = 0;
  particles.for_each_column([&](std::string_view, std::string_view, const auto& column) { bytes += bytes_of(column); });
  return bytes;
}

}  // namespace talus
