#include "io/python/python_script.hpp"

#include "io/system/plugin.hpp"

namespace talus {

std::unique_ptr<PythonScript> open_python_script(const std::string& file)
{
  static const auto& part = *static_cast<const PythonPart*>(
      open_module("python", "talus_python_part", "runs scripts in Python (on Debian it needs libpython3 and python3-numpy)"));
  return part.open(file);
}

}  // namespace talus
