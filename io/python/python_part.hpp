#pragma once
// The functions of the plugin libtalus_python.so, which holds the interpreter, because few runs need it.
#include <memory>
#include <string>

#include "materials/interface/talus_law.h"

namespace talus {

class PythonScript;

struct PythonPart {
  std::unique_ptr<PythonScript> (*open_script)(const std::string& file);
  const talus_law* (*open_law)(const std::string& file, const std::string& name);
};

/// Opens the plugin at the first call.  Throws EnvironmentError if it is not there.
const PythonPart& python_part();

}  // namespace talus
