#pragma once
// Common parts of the rules between the blocks of a scene: findings, names that must exist or differ, lists that must fit the dimension.
#include <algorithm>

#include <fmt/format.h>

#include "io/scene/scene_rules.hpp"

namespace talus {

class SceneRuleBase {
 public:
  explicit SceneRuleBase(const Scene& scene) : scene_(scene) {}

 protected:
  void add(std::string path, std::string message) { findings_.push_back({std::move(path), std::move(message)}); }

  /// Whether a word is given and known; an unknown word is a finding, with the nearest known one.
  bool known_word(std::string path, std::string_view what, const std::string& word, const std::vector<std::string>& known);
  /// A list of known words without repetition.
  void known_words(const std::string& path, std::string_view what, const std::vector<std::string>& words,
                   const std::vector<std::string>& known);

  template <class Item>
  static std::vector<std::string> names(const std::vector<Item>& items)
  {
    std::vector<std::string> all;
    for (const Item& item : items)
      all.push_back(item.name);
    return all;
  }
  template <class Item>
  void different_names(const std::string& path, const std::vector<Item>& items)
  {
    const auto all = names(items);
    for (auto name = all.begin(); name != all.end(); ++name)
      if (const auto first = std::find(all.begin(), name, *name); first != name && !name->empty())
        add(fmt::format("{}[{}].name", path, name - all.begin()),
            fmt::format("\"{}\" is the name of {}[{}] already", *name, path, first - all.begin()));
  }

  /// A list with one entry per dimension, unless it is empty.
  template <class T>
  void fits(const std::string& path, const std::vector<T>& list)
  {
    if (scene_.dimension != 0 && !list.empty() && list.size() != static_cast<std::size_t>(scene_.dimension))
      add(path, fmt::format("needs {} values in {} dimensions, not {}", scene_.dimension, scene_.dimension, list.size()));
  }
  /// Checks that the lists of a shape have one entry per dimension, and that the shape exists in this dimension.
  void fits(const std::string& path, const Shape& shape);
  void fits(const std::string& path, const SimpleShape& shape);

  void fits(const std::string& path, const Box& box);
  void fits(const std::string& path, const Sphere& sphere);
  void fits(const std::string& path, const Cylinder& cylinder);
  void fits(const std::string& path, const Polygon& polygon);
  void fits(const std::string& path, const Ring& ring);
  void fits(const std::string& path, const Difference& difference);
  void fits(const std::string& path, const Union& all);
  void fits(const std::string& path, const Intersection& all);
  void fits_all(const std::string& path, const std::vector<SimpleShape>& parts);

  const Scene& scene_;
  std::vector<Finding> findings_;
};

}  // namespace talus
