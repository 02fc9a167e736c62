#include "io/output/history_columns.hpp"

#include <fmt/format.h>

#include "core/field_component.hpp"

namespace talus {

std::vector<CsvColumn> csv_columns(std::string_view pattern, std::string_view unit, QuantityKind kind, std::string_view owner,
                                   int dimension)
{
  const std::string name = fmt::format(fmt::runtime(pattern), owner);
  std::vector<std::string> components = component_names(components_of(kind));
  if (dimension == 2 && kind == QuantityKind::vector)
    components = {"x", "y"};
  if (dimension == 2 && kind == QuantityKind::moment)
    components = {"z"};
  if (kind == QuantityKind::number)
    components = {""};
  std::vector<CsvColumn> all;
  for (const std::string& component : components)
    all.push_back({name + component, unit_in(dimension, unit)});
  return all;
}

}  // namespace talus
