#pragma once
// Collects what is wrong with a scene once its mesh is known, so that everything is said at once.
#include <fmt/format.h>

#include "core/word_match.hpp"
#include "io/scene/scene.hpp"

namespace talus {

class SceneErrorCollector {
 public:
  explicit SceneErrorCollector(const Scene& scene) : scene_(&scene) {}

  /// About the value of `key` in the mapping at `where`; an empty key means the mapping itself.
  void add(SourceLocation where, std::string_view key, std::string message);
  /// What is wrong in a file that the value of `key` there names.
  void add(const SourceLocation& where, std::string_view key, const SceneErrors& in_file);
  /// There is no such group: names the nearest one, or all.
  void unknown_group(const SourceLocation& where, std::string_view key, std::string_view kind, const std::string& name,
                     std::vector<std::string> known);
  void throw_if_any() const;

 private:
  const Scene* scene_;
  std::vector<SceneError> problems_;
};

}  // namespace talus
