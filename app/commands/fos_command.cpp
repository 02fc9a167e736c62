// The command talus fos, which is written in Python.
#include "app/commands/fos_command.hpp"

#include "app/commands/python_process.hpp"
#include "core/error.hpp"
#include "core/parallel/communicator.hpp"

namespace talus {

void find_fos(const FosOptions& options)
{
  if (!world().alone())
    throw Error("talus fos starts runs of its own and is started once: to have each on several ranks, --launcher \"mpirun -n 4\"");
  forget_launch();
  become_command("fos", options.scene.string(), options.words);
}

}  // namespace talus
