// Rules between the keys of the block `mesh.terrain`.
#include "io/scene_terrain.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/words.hpp"

namespace talus {

namespace {

using Points = std::vector<std::vector<Real>>;
using Messages = std::vector<std::string>;

void check_place(std::string_view key, const std::vector<Real>& place, Messages& problems)
{
  if (place.size() != 2)
    problems.push_back(fmt::format("{} needs two numbers, [east, north]", key));
}

/// Two corners of a rectangle or all of a polygon; one number each where the plan is a line.
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

template <class Spec>
void check_names(std::string_view what, const std::vector<Spec>& list, Messages& problems)
{
  for (auto one = list.begin(); one != list.end(); ++one)
    if (std::any_of(list.begin(), one, [&](const Spec& other) { return other.name == one->name; }))
      problems.push_back(fmt::format("two {} have the name \"{}\"", what, one->name));
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
  check_names("layers", layers, problems);
  check_names("obstacles", obstacles, problems);
  std::vector<std::string> known;
  for (const LayerSpec& layer : layers)
    known.push_back(layer.name);
  const auto check_layer = [&](std::string_view key, const std::string& name) {
    if (!name.empty() && std::find(known.begin(), known.end(), name) == known.end())
      problems.push_back(fmt::format("{}: there is no layer \"{}\"{}", key, name, suggestion(name, known)));
  };
  if (air && air->reach && layers.empty())
    problems.emplace_back("air.reach is counted from a layer, and there are none");
  if (air)
    check_layer("air.of", air->of);
  for (std::size_t i = 0; i < refine.size(); ++i)
    check_layer(fmt::format("refine[{}].down_from", i), refine[i].down_from);
  if (air)
    for (std::size_t i = 0; i < obstacles.size(); ++i)
      if (obstacles[i].height > air->height)
        problems.push_back(fmt::format("obstacles[{}] \"{}\" is {:.6g} m high, more than the air, {:.6g} m", i, obstacles[i].name,
                                       obstacles[i].height, air->height));
}

}  // namespace talus
