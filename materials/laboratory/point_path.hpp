#pragma once
// Drives one law along a path of strain rates, velocity gradients and stresses: triaxial tests, oedometers, simple shear.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "materials/interface/material.hpp"

namespace talus {

/// What is prescribed for one component of the path.
enum class Controlled : std::uint8_t { strain_rate, velocity_gradient, stress };
constexpr auto enum_names(Controlled) { return std::array<std::string_view, 3>{"strain_rate", "velocity_gradient", "stress"}; }

struct Control {
  Controlled quantity = Controlled::strain_rate;
  Real value = 0;
  static constexpr auto fields()
  {
    return std::tuple{
        required_choice("quantity", &Control::quantity,
                        "strain_rate: D_ij without spin; velocity_gradient: L_ij alone, L_ji = 0 (simple shear); stress: Cauchy"),
        required("value", &Control::value, any, "1/s or Pa", "constant rate, or the stress reached linearly over the path")};
  }
};

/// Control of each component; those not named have no strain rate.
struct Controls {
  std::optional<Control> xx{}, yy{}, zz{}, xy{}, yz{}, xz{};
  static constexpr auto fields()
  {
    return std::tuple{group("xx", &Controls::xx, "normal component along x"), group("yy", &Controls::yy, "normal component along y"),
                      group("zz", &Controls::zz, "normal component along z"), group("xy", &Controls::xy, "shear component xy"),
                      group("yz", &Controls::yz, "shear component yz"),       group("xz", &Controls::xz, "shear component xz")};
  }
  std::array<Control, 6> all() const  ///< in the order of Sym3
  {
    return {xx.value_or(Control{}), yy.value_or(Control{}), zz.value_or(Control{}),
            xy.value_or(Control{}), yz.value_or(Control{}), xz.value_or(Control{})};
  }
};

/// Part of a test: steps of equal length under constant controls.
struct PointPath {
  Index steps = 100;
  Real time = 1;
  Controls controls{};
  SourceLocation where{};
  static constexpr auto fields()
  {
    return std::tuple{optional("steps", &PointPath::steps, positive, "-", "number of steps"),
                      optional("time", &PointPath::time, positive, "s", "duration"),
                      group("controls", &PointPath::controls, "what is prescribed for each component")};
  }
};

/// State of the point at one time.  p = -tr(stress)/3, q = sqrt(3 J2) [Pa].
struct PointRow {
  Real time;  ///< s
  Mat3 F, stress;
  Real p, q;
  std::vector<Real> history;  ///< under PointTable::history_names
};
struct PointTable {
  std::vector<std::string> history_names;  ///< with units; a tensor appears as key_xx, key_yy, key_zz, key_xy, key_yz, key_xz
  std::vector<PointRow> rows;              ///< the start, then the end of every step
};

/// Drives the first particle of `batch` (which must have one) along `paths`, one after the other, from rest with `initial_stress` [Pa].
/// Strain rates that belong to prescribed stresses are found by Newton's method with numerical tangent and line search.
/// RunError, with path, step and time: the law has no answer, cannot start from a stress, or the stress cannot be reached.
PointTable drive(Material batch, std::span<const PointPath> paths, const Mat3& initial_stress = Mat3::Zero());

}  // namespace talus
