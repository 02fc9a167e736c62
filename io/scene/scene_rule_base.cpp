#include "io/scene/scene_rule_base.hpp"

#include "core/word_match.hpp"

namespace talus {

bool SceneRuleBase::known_word(std::string path, std::string_view what, const std::string& word, const std::vector<std::string>& known)
{
  if (word.empty())
    return false;
  const bool is_known = std::find(known.begin(), known.end(), word) != known.end();
  if (!is_known)
    add(std::move(path), fmt::format("there is no {} \"{}\"{}", what, word, suggestion(word, known)));
  return is_known;
}

void SceneRuleBase::known_words(const std::string& path, std::string_view what, const std::vector<std::string>& words,
                                const std::vector<std::string>& known)
{
  for (auto word = words.begin(); word != words.end(); ++word) {
    const std::string at = fmt::format("{}[{}]", path, word - words.begin());
    known_word(at, what, *word, known);
    if (!word->empty() && std::find(words.begin(), word, *word) != word)
      add(at, fmt::format("\"{}\" is asked for twice", *word));
  }
}

void SceneRuleBase::fits(const std::string& path, const Box& box)
{
  fits(path + ".low", box.low);
  fits(path + ".high", box.high);
}

void SceneRuleBase::fits(const std::string& path, const Sphere& sphere) { fits(path + ".centre", sphere.centre); }

void SceneRuleBase::fits(const std::string& path, const Cylinder& cylinder)
{
  if (scene_.dimension == 2)
    return add(path + ".type", "a cylinder needs 3 dimensions; in 2 use a sphere or a box");
  fits(path + ".from", cylinder.from);
  fits(path + ".to", cylinder.to);
}

void SceneRuleBase::fits(const std::string& path, const Polygon& polygon)
{
  if (scene_.dimension == 3 && polygon.extrude.empty() && !polygon.points.empty())
    add(path, "missing key \"extrude\" [m]: in 3 dimensions a polygon has [z from, z to]");
  if (scene_.dimension == 2 && !polygon.extrude.empty())
    add(path + ".extrude", "a polygon is extruded in 3 dimensions only");
}

void SceneRuleBase::fits(const std::string& path, const Ring& ring) { fits(path + ".centre", ring.centre); }

void SceneRuleBase::fits(const std::string& path, const SimpleShape& shape)
{
  std::visit([&](const auto& s) { fits(path, s); }, shape);
}

void SceneRuleBase::fits_all(const std::string& path, const std::vector<SimpleShape>& parts)
{
  for (std::size_t i = 0; i < parts.size(); ++i)
    fits(fmt::format("{}[{}]", path, i), parts[i]);
}

void SceneRuleBase::fits(const std::string& path, const Difference& difference)
{
  fits(path + ".of", difference.of);
  fits_all(path + ".without", difference.without);
}

void SceneRuleBase::fits(const std::string& path, const Union& all) { fits_all(path + ".of", all.of); }

void SceneRuleBase::fits(const std::string& path, const Intersection& all) { fits_all(path + ".of", all.of); }

void SceneRuleBase::fits(const std::string& path, const Shape& shape)
{
  std::visit([&](const auto& s) { fits(path, s); }, shape);
}

}  // namespace talus
