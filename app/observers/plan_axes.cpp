#include "app/observers/plan_axes.hpp"

namespace talus {

template <int D>
PlanAxes plan_axes(const Vec<D>& gravity)
{
  PlanAxes axes;
  axes.up = gravity.norm() > 0 ? Vec3(-in_space<D>(gravity).normalized()) : D == 2 ? Vec3(Vec3::UnitY()) : Vec3(Vec3::UnitZ());
  axes.up.cwiseAbs().maxCoeff(&axes.vertical);
  axes.sign = axes.up[axes.vertical] < 0 ? -1 : 1;
  axes.plan =
      D == 2 ? std::array<Index, 2>{1 - axes.vertical, none} : std::array<Index, 2>{(axes.vertical + 1) % 3, (axes.vertical + 2) % 3};
  return axes;
}

template PlanAxes plan_axes<2>(const Vec<2>&);
template PlanAxes plan_axes<3>(const Vec<3>&);

}  // namespace talus
