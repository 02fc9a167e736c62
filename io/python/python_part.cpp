#include "io/python/python_part.hpp"

#include "io/python/python_law.hpp"
#include "io/python/python_script.hpp"
#include "io/system/plugin.hpp"

namespace talus {

const PythonPart& python_part()
{
  static const auto& part = *static_cast<const PythonPart*>(open_module(
      "python", "talus_python_part", "runs scripts and material laws in Python (on Debian it needs libpython3 and python3-numpy)"));
  return part;
}

std::unique_ptr<PythonScript> open_python_script(const std::string& file) { return python_part().open_script(file); }

const talus_law* open_python_law(const std::string& file, const std::string& name) { return python_part().open_law(file, name); }

}  // namespace talus
