// What libtalus_python.so offers the program.
#include "io/python/embedded_python.hpp"
#include "io/python/python_part.hpp"
#include "io/python/python_script.hpp"

extern "C" {
extern const talus::PythonPart talus_python_part;
const talus::PythonPart talus_python_part{talus::embedded_script, talus::embedded_law};
}
