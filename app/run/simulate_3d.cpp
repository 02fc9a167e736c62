// Every kernel of 3-D, compiled once.
#include "app/run/simulation.hpp"

namespace talus {

template Real first_step<3>(const Mesh<3>&, const Setup<3>&);
template void simulate<3>(const Scene&, Mesh<3>, Setup<3>, const RunCallbacks<3>&, const LoadBalancing<3>&);
template Estimate estimate<3>(const Scene&, Mesh<3>, Setup<3>);

}  // namespace talus
