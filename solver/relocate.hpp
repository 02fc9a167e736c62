#pragma once
// The cell of every particle, the order by cell, and particles that are about to leave the mesh.
#include "core/health.hpp"
#include "materials/batch.hpp"
#include "mesh/locate.hpp"
#include "solver/cell_order.hpp"
#include "solver/ledger.hpp"

namespace talus {

enum class OnExitPolicy : std::uint8_t { stop, remove };

/// What happens at the boundary of the mesh.
struct Exits {
  OnExitPolicy policy = OnExitPolicy::stop;
  std::vector<std::uint8_t> closed;  ///< one bit per local facet of each cell: a wall that no particle passes
};

/// Finds each particle's cell.  A particle outside behind a closed facet is set back onto it: weights of moving least squares do
/// not vanish beside a wall, so round-off of a cell's size may carry a particle across.  Others are reported lost or deleted.
/// What deleted particles take along is booked.  Afterwards `order` is sorted, and the arrays follow it when too many rows are out of
/// place.  True if rows changed place.
template <int D>
bool relocate(const Mesh<D>& mesh, const Locator<D>& locator, const Exits& exits, std::vector<Body>& bodies,
              std::vector<AnyBatch>& materials, Particles<D>& particles, CellOrder& order, MassLedger<D>& mass, EnergyLedger& energy,
              Health& health);

/// Deletes the particles that no step can go on from: position, velocity, deformation or stress not finite, or turned inside out.
/// `order` has to be made anew.
template <int D>
void remove_failed(std::vector<Body>& bodies, std::vector<AnyBatch>& materials, Particles<D>& particles, CellOrder& order,
                   MassLedger<D>& mass, EnergyLedger& energy);

extern template bool relocate<2>(const Mesh<2>&, const Locator<2>&, const Exits&, std::vector<Body>&, std::vector<AnyBatch>&, Particles<2>&,
                                 CellOrder&, MassLedger<2>&, EnergyLedger&, Health&);
extern template bool relocate<3>(const Mesh<3>&, const Locator<3>&, const Exits&, std::vector<Body>&, std::vector<AnyBatch>&, Particles<3>&,
                                 CellOrder&, MassLedger<3>&, EnergyLedger&, Health&);
extern template void remove_failed<2>(std::vector<Body>&, std::vector<AnyBatch>&, Particles<2>&, CellOrder&, MassLedger<2>&, EnergyLedger&);
extern template void remove_failed<3>(std::vector<Body>&, std::vector<AnyBatch>&, Particles<3>&, CellOrder&, MassLedger<3>&, EnergyLedger&);

}  // namespace talus
