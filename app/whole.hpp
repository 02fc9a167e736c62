#pragma once
// What several ranks hold, brought together on one: for files.
#include "app/frame.hpp"
#include "io/vtk.hpp"

namespace talus {

/// The particles of all ranks, in the order of bodies and ids, in cells of the whole mesh.
template <int D>
struct WholeParticles {
  Particles<D> particles;
  std::vector<Body> bodies;
  std::vector<AnyBatch> materials;
};

/// On the root; elsewhere nothing.  Every rank has to ask.
template <int D>
WholeParticles<D> gather_particles(const Frame<D>& frame);

/// A column of all nodes of the whole mesh from that of the nodes held here.  As above.
template <int D>
Column whole_column(const Frame<D>& frame, Column held);

/// f(frame) on the root, the frame with the particles of all ranks and without their order; what it throws every rank throws.  The frame has
/// the mesh, and what is on it, of the root alone.  Every rank has to ask.
template <int D, class F>
void on_root(const Frame<D>& frame, F&& f)
{
  if (frame.ranks->alone())
    return f(frame);
  const WholeParticles<D> whole = gather_particles(frame);
  const CellOrder no_order;
  frame.ranks->together([&] {
    f(Frame<D>{frame.mesh,       frame.share,        whole.particles, whole.bodies,   whole.materials, no_order,
               frame.ranks,      frame.nodes,        frame.walls,     frame.loads,    frame.clock,     frame.stage,
               frame.stage_name, frame.stage_number, frame.energy,    frame.mass,     frame.momentum,  frame.watched,
               frame.guards,     frame.timings,      frame.residual,  frame.crossing, frame.migrated});
  });
}

extern template WholeParticles<2> gather_particles<2>(const Frame<2>&);
extern template WholeParticles<3> gather_particles<3>(const Frame<3>&);
extern template Column whole_column<2>(const Frame<2>&, Column);
extern template Column whole_column<3>(const Frame<3>&, Column);

}  // namespace talus
