#include "app/commands/package_command.hpp"

#include <fmt/format.h>

#include "app/commands/python_process.hpp"
#include "core/error.hpp"
#include "core/parallel/communicator.hpp"

namespace talus {

void run_in_package(const PackageCommand& command)
{
  if (command.starts_runs) {
    if (!world().alone())
      throw Error(fmt::format(
          "talus {} starts runs of its own and is started once: to have each on several ranks, --launcher \"mpirun -n 4\"", command.name));
    forget_launch();
  }
  become_command(command.name, command.words);
}

}  // namespace talus
