// The command talus converge, which is written in Python.
#include "app/commands/converge_command.hpp"

#include "app/commands/python_process.hpp"
#include "core/error.hpp"
#include "core/parallel/communicator.hpp"

namespace talus {

void converge(const ConvergeOptions& options)
{
  if (!world().alone())
    throw Error("talus converge starts runs of its own and is started once: to have each on several ranks, --launcher \"mpirun -n 4\"");
  forget_launch();
  become_command("converge", options.scene.string(), options.words);
}

}  // namespace talus
