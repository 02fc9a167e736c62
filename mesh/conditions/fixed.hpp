#pragma once
// Nodes held at rest.
#include "mesh/conditions/boundary_common.hpp"
#include "mesh/conditions/condition_setup.hpp"
#include "mesh/conditions/dynamic_phase.hpp"

namespace talus {

struct FixedOptions : BoundaryCommon {
  static constexpr std::string_view name = "fixed";
  static constexpr auto fields() { return std::tuple{on_key("node, facet or cell group held at rest"), during_key()}; }
};

template <int D>
struct Fixed {
  using Options = FixedOptions;
  static Fixed make(const Options&, const ConditionSetup<D>&) { return {}; }

  static Vec<D> velocity(const DynamicPhase&, Real) noexcept { return Vec<D>::Zero(); }
  template <class Node>
  void hold(const DynamicPhase&, Node& node) const noexcept
  {
    node.push(Vec<D>::Zero() - node.v);
  }
  ColumnBase<D> column_base(const DynamicPhase&, Real) const noexcept { return {}; }
};

}  // namespace talus
