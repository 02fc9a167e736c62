// Rules between the keys of one block; names of walls; which way is up.
#include "io/scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace talus {

namespace {

/// Adds an error unless exactly one of the keys is given.
void exactly_one(std::string_view keys, int found, std::vector<std::string>& problems)
{
  if (found == 0)
    problems.push_back(fmt::format("one of {} is needed", keys));
  if (found > 1)
    problems.push_back(fmt::format("only one of {} may be given", keys));
}

}  // namespace

void GridSpec::check(std::vector<std::string>& problems) const { check_corners(low, high, problems); }

void GroupSpec::check(std::vector<std::string>& problems) const
{
  if (!within && facing.empty())
    problems.emplace_back("within, facing or both say which facets belong to the group");
  if (!facing.empty() && std::all_of(facing.begin(), facing.end(), [](Real x) { return x == 0; }))
    problems.emplace_back("facing is no direction: all of its numbers are 0");
}

void MeshSpec::check(std::vector<std::string>& problems) const
{
  exactly_one("file, geometry, regions, grid or terrain",
              !file.empty() + !geometry.empty() + !regions.empty() + grid.has_value() + terrain.has_value(), problems);
  const bool meshed = !geometry.empty() || !regions.empty();
  if ((meshed || terrain) && !size)
    problems.push_back(fmt::format("missing key \"size\" [m]: {} meshed", terrain ? "terrain is" : "geometry and regions are"));
  if (!meshed && !terrain && size)
    problems.push_back("size is for geometry, regions and terrain only");
  if (!meshed && !refine.empty())
    problems.push_back(fmt::format("refine is for geometry and regions only{}", terrain ? "; terrain has a refine of its own" : ""));
  if (!file.empty() && std::filesystem::path(file).extension() != ".msh")
    problems.push_back(fmt::format("file \"{}\" does not end in .msh; a .geo or .step file is given as geometry", file));
  static constexpr std::array<std::string_view, 6> kinds{".geo", ".step", ".stp", ".brep", ".iges", ".igs"};
  if (!geometry.empty() && std::find(kinds.begin(), kinds.end(), std::filesystem::path(geometry).extension()) == kinds.end())
    problems.push_back(fmt::format("geometry \"{}\" does not end in .geo, .step, .stp, .brep, .iges or .igs", geometry));
}

void TimeSpec::check(std::vector<std::string>& problems) const
{
  if (max_step && *max_step < min_step)
    problems.push_back(fmt::format("max_step {} s is smaller than min_step {} s", *max_step, min_step));
}

void TractionSpec::check(std::vector<std::string>& problems) const
{
  exactly_one("traction, pressure or water_level", !traction.empty() + pressure.has_value() + water_level.has_value(), problems);
}

void GeostaticSpec::check(std::vector<std::string>& problems) const
{
  if (ramp > duration)
    problems.push_back(fmt::format("ramp {} s is longer than the stage, {} s", ramp, duration));
  if (ramp_shape != RampShape::linear && ramp == 0)
    problems.emplace_back("ramp_shape is of a ramp, and there is none: give ramp, the time over which the loads grow");
}

void SectionSpec::check(std::vector<std::string>& problems) const
{
  if (name.find('/') != name.npos || name.starts_with('.'))
    problems.push_back(fmt::format("name \"{}\" cannot be that of a file", name));
  if (along.size() < 2)
    problems.push_back("along needs two corners at least");
  for (std::size_t i = 0; i < along.size(); ++i) {
    if (along[i].size() != 2)
      problems.push_back(fmt::format("along[{}] needs two numbers, not {}", i, along[i].size()));
    else if (i > 0 && along[i] == along[i - 1])
      problems.push_back(fmt::format("along[{}] is the corner before it", i));
  }
}

void K0Rule::check_rule(std::vector<std::string>& problems) const
{
  if (ocr != 1 && !from_friction)
    problems.push_back("ocr is for from_friction: true only");
  for (std::size_t i = 0; i < k0_table.size(); ++i)
    if (k0_table[i].size() != 2)
      problems.push_back(fmt::format("k0_table[{}] needs 2 values, depth and k0, not {}", i, k0_table[i].size()));
    else if (i > 0 && k0_table[i - 1].size() == 2 && !(k0_table[i][0] > k0_table[i - 1][0]))
      problems.push_back(fmt::format("k0_table[{}]: the depth {} m does not come below {} m", i, k0_table[i][0], k0_table[i - 1][0]));
}

void K0OfBody::check(std::vector<std::string>& problems) const
{
  exactly_one("k0, k0_table, from_friction or stress", given(), problems);
  check_rule(problems);
}

void K0Spec::check(std::vector<std::string>& problems) const
{
  if (given() > 1 || bodies.empty())
    exactly_one("k0, k0_table, from_friction or stress", given(), problems);
  check_rule(problems);
}

const K0Rule& K0Spec::of(const std::string& body) const noexcept
{
  const auto own = std::find_if(bodies.begin(), bodies.end(), [&](const K0OfBody& b) { return b.body == body; });
  return own == bodies.end() ? static_cast<const K0Rule&>(*this) : *own;
}

void PictureSpec::check(std::vector<std::string>& problems) const
{
  if (!range.empty() && (range.size() != 2 || !(range[0] < range[1])))
    problems.push_back("range needs two numbers, the smaller one first");
  const auto needs_direction = [&](std::string_view key, const std::vector<Real>& v) {
    if (v.size() != 3 || (v[0] == 0 && v[1] == 0 && v[2] == 0))
      problems.push_back(fmt::format("{} needs three numbers that are not all zero", key));
  };
  needs_direction("view", view);
  if (!up.empty())
    needs_direction("up", up);
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

std::optional<Vec3> against_gravity(const Scene& scene)
{
  for (const LoadSpec& load : scene.loads)
    if (const auto* gravity = std::get_if<GravitySpec>(&load)) {
      Vec3 up = Vec3::Zero();
      for (std::size_t d = 0; d < std::min<std::size_t>(3, gravity->acceleration.size()); ++d)
        up[static_cast<Index>(d)] = 0 - gravity->acceleration[d];  // not -0
      if (up.norm() > 0)
        return up.normalized();
    }
  return std::nullopt;
}

Vec3 upright_of(const Scene& scene)
{
  return against_gravity(scene).value_or(scene.dimension == 2 ? Vec3(Vec3::UnitY()) : Vec3(Vec3::UnitZ()));
}

}  // namespace talus
