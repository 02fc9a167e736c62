#pragma once
// Material laws in Python, behind the interface of laws in shared libraries.
#include <string>

#include "materials/interface/talus_law.h"

namespace talus {

/// The law of this name in a file, which is read once; valid as long as the process.  Starts Python, if it does not run.  Throws RunError, with file
/// and line, for what is wrong in it, and EnvironmentError without Python or NumPy.
const talus_law* open_python_law(const std::string& file, const std::string& name);

}  // namespace talus
