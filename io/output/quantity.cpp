#include "io/output/quantity.hpp"

namespace talus {

std::string unit_in(int dimension, std::string_view unit)
{
  if (unit == "m^D")
    return dimension == 2 ? "m^2" : "m^3";
  if (unit == "m^(D-1)")
    return dimension == 2 ? "m" : "m^2";
  return unit == "-" ? "" : std::string(unit);
}

}  // namespace talus
