// Rules of the block `rigid`.
#include "io/scene/scene_rule_base.hpp"

namespace talus {

void RigidSpec::check(std::vector<std::string>& problems) const
{
  const int looks = (shape ? 1 : 0) + (file.empty() ? 0 : 1) + (sheet.empty() ? 0 : 1) + (sheet_file.empty() ? 0 : 1);
  if (looks != 1)
    problems.emplace_back("give one of shape, file, sheet and sheet_file: exactly one of them says what the body looks like");
  if (!at.empty() && file.empty() && sheet_file.empty())
    problems.emplace_back("at is where the origin of a file lies; shapes and sheets have places of their own");
  if (is_sheet() && density)
    problems.emplace_back("a sheet has no volume: give its mass instead of a density");
  if (mass && density)
    problems.emplace_back("give mass or density, not both");
  if (motion == RigidMotionKind::free && !mass && !density)
    problems.emplace_back("a free body needs mass or density; motion: given moves it without");
  if (motion == RigidMotionKind::given && !inertia.empty())
    problems.emplace_back("a given motion does not depend on inertia: leave it out");
  if (motion == RigidMotionKind::free && !table.points.empty())
    problems.emplace_back("a table is of a given motion: add motion: given, or leave it out");
}

namespace {

class RigidRules : private SceneRuleBase {
 public:
  using SceneRuleBase::SceneRuleBase;

  std::vector<Finding> broken()
  {
    different_names("rigid", scene_.rigid);
    const auto bodies = names(scene_.bodies);
    const std::size_t axes = scene_.dimension == 2 ? 1 : 3;
    for (std::size_t i = 0; i < scene_.rigid.size(); ++i) {
      const RigidSpec& rigid = scene_.rigid[i];
      const std::string path = fmt::format("rigid[{}]", i);
      if (std::ranges::find(bodies, rigid.name) != bodies.end())
        add(path + ".name", fmt::format("\"{}\" is the name of a body already", rigid.name));
      if (rigid.shape)
        shape(path + ".shape", *rigid.shape);
      if (!rigid.file.empty() && scene_.dimension == 2)
        add(path + ".file", "an STL file is a surface in space: in 2 dimensions give a shape");
      if (!rigid.sheet_file.empty() && scene_.dimension == 2)
        add(path + ".sheet_file", "an STL file is a surface in space: in 2 dimensions give the points of a sheet");
      if (rigid.is_sheet())
        sheet(path, rigid);
      fits(path + ".at", rigid.at);
      fits(path + ".velocity", rigid.velocity);
      for (const auto& [key, list] : {std::pair{".inertia", &rigid.inertia}, std::pair{".angular_velocity", &rigid.angular_velocity}})
        if (scene_.dimension != 0 && !list->empty() && list->size() != axes)
          add(path + key,
              fmt::format("needs {} value{} in {} dimensions, not {}", axes, axes == 1 ? "" : "s", scene_.dimension, list->size()));
    }
    if (!scene_.rigid.empty())
      for (std::size_t i = 0; i < scene_.boundaries.size(); ++i)
        if (has_dashpots(scene_.boundaries[i]))
          add(fmt::format("boundaries[{}]", i), "absorbing boundaries do not know rigid bodies: leave one of them out");
    return std::move(findings_);
  }

 private:
  void sheet(const std::string& path, const RigidSpec& rigid)
  {
    const std::string key = fmt::format("{}.{}", path, rigid.key_of_shape());
    const auto least = static_cast<std::size_t>(scene_.dimension);
    if (!rigid.sheet.empty() && scene_.dimension != 0 && rigid.sheet.size() < least)
      add(key, fmt::format("a sheet needs at least {} points in {} dimensions, not {}", least, least, rigid.sheet.size()));
    for (std::size_t k = 0; k < rigid.sheet.size(); ++k) {
      fits(fmt::format("{}[{}]", key, k), rigid.sheet[k]);
      if (rigid.sheet[k].empty())
        add(fmt::format("{}[{}]", key, k), "a point has one number per dimension");
      if (k > 0 && rigid.sheet[k] == rigid.sheet[k - 1])
        add(fmt::format("{}[{}]", key, k), "repeats the point before: leave it out");
    }
    if (!scene_.contacts.empty())
      add(key, "sheets and contacts of bodies cannot act in one scene yet: leave one of them out");
    if (!scene_.cuts.empty())
      add(key, "sheets and cuts of the mesh cannot act in one scene yet: leave one of them out");
    if (scene_.kernel == "projected" && scene_.projected && scene_.projected->surfaces == AtSurfaces::extended)
      add(key, "beside a sheet gradients are not extended: leave out `projected: {surfaces: extended}`");
  }
  void shape(const std::string& path, const Shape& shape)
  {
    fits(path, shape);
    std::visit(
        [&]<class S>(const S& s) {
          if constexpr (std::is_same_v<S, Polygon>) {
            if (!s.holes.empty())
              add(path + ".holes", "a rigid body has no holes: leave them out");
          } else if constexpr (!std::is_same_v<S, Box> && !std::is_same_v<S, Sphere> && !std::is_same_v<S, Cylinder>) {
            add(path, fmt::format("a rigid body is a box, sphere, cylinder or polygon, or comes from a file; not a {}", S::name));
          }
        },
        shape);
  }
};

}  // namespace

std::vector<Finding> broken_rigid_rules(const Scene& scene) { return RigidRules(scene).broken(); }

}  // namespace talus
