// Rules between the keys of the block `mesh.terrain`.
#include "io/scene/scene_terrain.hpp"

#include <fmt/format.h>

namespace talus {

void SurfaceSpec::check(std::vector<std::string>& problems) const
{
  const int given = (file.empty() ? 0 : 1) + (elevation ? 1 : 0) + (depth ? 1 : 0) + (points.empty() ? 0 : 1);
  if (given != 1)
    problems.emplace_back("a surface is exactly one of file, elevation, depth and points");
}

namespace {

using Points = std::vector<std::vector<Real>>;
using Messages = std::vector<std::string>;

void check_place(std::string_view key, const std::vector<Real>& place, Messages& problems)
{
  if (place.size() != 2)
    problems.push_back(fmt::format("{} needs two numbers, [east, north]", key));
}

/// Checks the two corners of a rectangle or all corners of a polygon; one number each if the plan is a line.
void check_area(std::string_view key, const Points& corners, const std::string& file, Messages& problems)
{
  if (!corners.empty() && !file.empty())
    problems.push_back(fmt::format("only one of {0} and {0}_file may be given", key));
  if (corners.size() == 1)
    problems.push_back(fmt::format("{} needs two corners of a rectangle, or three corners or more of a polygon", key));
  for (const auto& corner : corners)
    if (corner.size() != 2 && (corner.size() != 1 || corners.size() != 2))
      return problems.push_back(fmt::format("every corner of {} has two numbers, [east, north]", key));
}

}  // namespace

void TerrainSectionSpec::check(Messages& problems) const
{
  check_place("from", from, problems);
  check_place("to", to, problems);
  if (from.size() == 2 && from == to)
    problems.emplace_back("from and to are the same place");
}

void LayerSpec::check(Messages& problems) const { check_area("within", within, within_file, problems); }

void AirSpec::check(Messages& problems) const
{
  if (!of.empty() && !reach)
    problems.emplace_back("of says from which layer reach is counted: without reach, leave it out");
}

void FinerSpec::check(Messages& problems) const
{
  if (along.empty() == down_from.empty())
    problems.emplace_back("exactly one of along and down_from says where the line goes");
  if (along.size() == 1)
    problems.emplace_back("along needs two points or more");
  for (const auto& place : along)
    if (place.empty() || place.size() > 2)
      return problems.push_back("every point of along has two numbers, [east, north]");
}

void ObstacleSpec::check(Messages& problems) const
{
  check_area("outline", outline, outline_file, problems);
  if (outline.empty() && outline_file.empty())
    problems.emplace_back("one of outline and outline_file is needed");
}

void TerrainSpec::check(Messages& problems) const
{
  check_area("domain", domain, domain_file, problems);
  if (!origin.empty())
    check_place("origin", origin, problems);
  if (section && !(domain.empty() && domain_file.empty() && origin.empty()))
    problems.emplace_back("the section says where the mesh begins and ends: leave domain and origin out");
  if (ground.depth)
    problems.emplace_back("the ground cannot be given by its depth below the ground");
  if (layers.empty() && !air)
    problems.emplace_back("layers or air are needed: without them there is nothing to mesh");
  if (!obstacles.empty() && !air)
    problems.emplace_back("obstacles stand in the air: give air, with a height above them");
  if (air && air->reach && layers.empty())
    problems.emplace_back("air.reach is counted from a layer, and there are none");
}

}  // namespace talus
