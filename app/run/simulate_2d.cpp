// Every kernel of 2-D, compiled once.
#include "app/run/simulation.hpp"

namespace talus {

template Real first_step<2>(const Mesh<2>&, const Setup<2>&);
template void simulate<2>(const Scene&, Mesh<2>, Setup<2>, const RunCallbacks<2>&, const LoadBalancing<2>&);
template Estimate estimate<2>(const Scene&, Mesh<2>, Setup<2>);

}  // namespace talus
