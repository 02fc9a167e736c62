#include "io/scene/history_columns.hpp"

#include <fmt/format.h>

#include <array>
#include <map>
#include <variant>

namespace talus {

namespace {

constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};
constexpr std::array<const char*, 6> stress_names{"sxx", "syy", "szz", "sxy", "syz", "sxz"};

void add_vector(std::vector<CsvColumn>& columns, const std::string& prefix, int dimension, const char* unit)
{
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
    columns.push_back({prefix + axis_names[d], unit});
}

}  // namespace

std::vector<CsvColumn> common_columns(int dimension)
{
  std::vector<CsvColumn> all{{"time", "s"}, {"step"}, {"dt", "s"}, {"stage"}, {"mass", "kg"}};
  add_vector(all, "momentum_", dimension, "kg m/s");
  for (std::size_t d = dimension == 2 ? 2 : 0; d < 3; ++d)
    all.push_back({fmt::format("angular_momentum_{}", axis_names[d]), "kg m^2/s"});
  add_vector(all, "centre_", dimension, "m");
  for (const char* energy : {"kinetic", "strain", "plastic", "friction", "damping", "carried_away", "gravity_work", "load_work",
                             "wall_work", "transfer_loss", "energy_defect"})
    all.push_back({energy, "J"});
  all.push_back({"residual"});
  return all;
}

std::vector<CsvColumn> reaction_columns(const std::string& wall, int dimension)
{
  std::vector<CsvColumn> all;
  add_vector(all, fmt::format("reaction_{}_", wall), dimension, "N");
  return all;
}

std::vector<CsvColumn> columns_of(const PointSpec& point, int dimension)
{
  std::vector<CsvColumn> all;
  add_vector(all, point.name + "_", dimension, "m");
  add_vector(all, point.name + "_u", dimension, "m");
  add_vector(all, point.name + "_v", dimension, "m/s");
  for (const char* stress : stress_names)
    all.push_back({fmt::format("{}_{}", point.name, stress), "Pa"});
  return all;
}

std::vector<CsvColumn> columns_of(const FrontSpec& front) { return {{front.name, "m"}}; }

std::vector<CsvColumn> columns_of(const WallSpec& wall, int dimension)
{
  std::vector<CsvColumn> all{{"push_" + wall.on, "N"},
                             {"shear_" + wall.on, "N"},
                             {"touched_" + wall.on, dimension == 2 ? "m" : "m^2"},
                             {"pressure_" + wall.on, "Pa"}};
  add_vector(all, fmt::format("attack_{}_", wall.on), dimension, "m");
  return all;
}

std::vector<CsvColumn> columns_of(const MovedSpec& moved) { return {{moved.name, "m"}}; }

std::vector<CsvColumn> body_columns(const std::string& body, int dimension)
{
  std::vector<CsvColumn> all{{"mass_" + body, "kg"}};
  add_vector(all, fmt::format("momentum_{}_", body), dimension, "kg m/s");
  all.push_back({"kinetic_" + body, "J"});
  all.push_back({"plastic_" + body, "J"});
  add_vector(all, fmt::format("force_{}_", body), dimension, "N");
  return all;
}

std::vector<std::string> wall_names(const std::vector<BoundaryOptions>& boundaries)
{
  std::vector<std::string> names;
  std::map<std::string, int> times;
  for (const BoundaryOptions& boundary : boundaries) {
    const std::string& group = common_of(boundary).on;
    const int count = ++times[group];
    names.push_back(count == 1 ? group : fmt::format("{}_{}", group, count));
  }
  return names;
}

}  // namespace talus
