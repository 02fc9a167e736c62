#include "io/scene/study.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/document/field_reader.hpp"
#include "io/scene/study_samples.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_cases = 10'000;

Written written(std::string text, const Node& node, const std::string& path) { return {std::move(text), problem_at(node.place, path, "")}; }

/// The text of a sampled value, with six digits.
std::string sample_text(Real value) { return fmt::format("{:.6g}", value); }

/// The values of a key that has a distribution.
std::vector<Written> values_of(const Spread& spread, const std::string& key, const StudySpec& spec, const Node& node,
                               const std::string& path)
{
  std::vector<Written> values;
  if (spec.combine == Combine::tornado) {
    const LowMiddleHigh three = three_of(spread);
    for (const Real value : {three.middle, three.low, three.high})
      values.push_back(written(sample_text(value), node, path));
    return values;
  }
  const auto count = std::min(static_cast<std::size_t>(spec.samples.value_or(2)), most_cases);
  for (const Real share : latin_column(key, static_cast<std::uint64_t>(spec.seed.value_or(1)), count))
    values.push_back(written(sample_text(quantile(spread, share)), node, path));
  return values;
}

/// Checks keys that are valid for samples only.
void check_samples(const Node& root, const StudySpec& spec, Problems& problems)
{
  const bool latin = spec.combine == Combine::latin;
  if (latin && !spec.samples && root.find("samples") == nullptr)
    problems.add(root.find("combine")->place, "combine", "latin needs samples: how many cases there are to be");
  if (latin && spec.samples && *spec.samples > static_cast<Index>(most_cases))
    problems.add(root.find("samples")->place, "samples", fmt::format("these are more than {} cases", most_cases));
  for (const char* key : {"samples", "seed"})
    if (const Node* node = root.find(key); node != nullptr && !latin)
      problems.add(node->place, key, "is of combine: latin");
}

/// Keys with their valid values.
std::vector<Varied> read_vary(const StudySpec& spec, Problems& problems)
{
  const Node& vary = spec.vary;
  const bool spread_asked = spec.combine == Combine::latin || spec.combine == Combine::tornado;
  if (vary.kind != Node::Kind::mapping || vary.items.empty()) {
    if (vary.kind != Node::Kind::empty && vary.kind != Node::Kind::unreadable)
      problems.add(vary.place, "vary", "expected a mapping of keys of the scene, such as {mesh.size: [0.1, 0.2]}");
    return {};
  }
  std::vector<Varied> all;
  for (std::size_t k = 0; k < vary.items.size(); ++k) {
    const auto& [key, place] = vary.keys[k];
    const std::string path = path_to("vary", key);
    if (key.find('=') != key.npos)
      problems.add(place, path, fmt::format("\"{}\" is no path of keys such as time.end or materials[0].cohesion", key));
    Varied varied{key, {}};
    const Node& item = vary.items[k];
    if (spread_asked) {
      Spread spread;
      const std::size_t before = problems.size();
      if (item.kind == Node::Kind::list)
        problems.add(item.place, path,
                     fmt::format("expected a distribution, such as {{low: 1, high: 2}} or {{mean: 1.5, deviation: 0.2}}: combine is {}",
                                 spec.combine == Combine::latin ? "latin" : "tornado"));
      else
        FieldReader(problems).read(item, path, spread);
      if (problems.size() == before)
        varied.values = values_of(spread, key, spec, item, path);
      all.push_back(std::move(varied));
      continue;
    }
    if (item.kind == Node::Kind::mapping && item.find("low") != nullptr) {
      problems.add(item.place, path, "a distribution is of combine: latin or tornado");
      continue;
    }
    std::vector<Node> nodes;
    FieldReader(problems).read(item, path, nodes);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      varied.values.push_back(written(in_one_line(nodes[i]), vary.items[k].items[i], path_to(path, i, {})));
    all.push_back(std::move(varied));
  }
  return all;
}

/// Checks for lists with a length different from the first, and for repeated cases.
void check_cases(const Study& study, const Node& vary, Problems& problems)
{
  const auto place_of = [&](std::size_t k) { return vary.items[k].place; };
  std::size_t count = 1;
  for (std::size_t k = 0; k < study.vary.size(); ++k) {
    const std::vector<Written>& values = study.vary[k].values;
    const std::string path = path_to("vary", study.vary[k].key);
    if (study.combine == Combine::latin || study.combine == Combine::tornado)
      continue;
    if (study.combine == Combine::rows) {
      if (values.size() != study.vary.front().values.size())
        problems.add(place_of(k), path,
                     fmt::format("has {} values where {} has {}: in rows the first meets the first, the second the second", values.size(),
                                 study.vary.front().key, study.vary.front().values.size()));
      count = values.size();
      continue;
    }
    count = std::min(count * values.size(), most_cases + 1);
    for (std::size_t i = 1; i < values.size(); ++i)
      if (std::any_of(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(i),
                      [&](const Written& other) { return other.text == values[i].text; }))
        problems.add(vary.items[k].items[i].place, path_to(path, i, {}),
                     fmt::format("{} stands here twice: so would its cases", values[i].text));
  }
  if (count > most_cases)
    problems.add(vary.place, "vary", fmt::format("these are more than {} cases", most_cases));
}

}  // namespace

Study study_of(const fs::path& file, const Node& root, const StudySpec& spec, Problems& problems)
{
  Study study{.file = file.string(), .scene = {}, .vary = {}, .combine = spec.combine, .collect = {}, .exceed = spec.exceed};
  if (const Node* node = root.find("scene"); node != nullptr && !spec.scene.empty()) {
    study.scene = written(spec.scene, *node, "scene");
    if (std::error_code unknown; !fs::exists(scene_of(study), unknown))
      problems.add(node->place, "scene", fmt::format("there is no file {}", scene_of(study).string()));
  }
  for (std::size_t i = 0; i < spec.collect.size(); ++i)
    study.collect.push_back(written(spec.collect[i], root.find("collect")->items[i], path_to("collect", i, {})));
  const std::size_t before = problems.size();
  check_samples(root, spec, problems);
  study.vary = read_vary(spec, problems);
  if (problems.size() == before && !study.vary.empty())
    check_cases(study, spec.vary, problems);
  return study;
}

std::vector<StudyCase> cases_of(const Study& study)
{
  std::vector<StudyCase> cases;
  StudyCase middle;
  if (study.combine == Combine::tornado) {
    for (const Varied& varied : study.vary)
      middle.push_back(varied.values[0]);
    cases.push_back(middle);
    for (std::size_t k = 0; k < study.vary.size(); ++k)
      for (const std::size_t end : {1U, 2U}) {
        cases.push_back(middle);
        cases.back()[k] = study.vary[k].values[end];
      }
    return cases;
  }
  if (study.combine != Combine::grid) {
    cases.resize(study.vary.front().values.size());
    for (std::size_t i = 0; i < cases.size(); ++i)
      for (const Varied& varied : study.vary)
        cases[i].push_back(varied.values[i]);
    return cases;
  }
  cases.emplace_back();
  for (const Varied& varied : study.vary) {
    std::vector<StudyCase> longer;
    for (const StudyCase& one : cases)
      for (const Written& value : varied.values)
        longer.push_back(one), longer.back().push_back(value);
    cases = std::move(longer);
  }
  return cases;
}

std::vector<std::string> changes_of(const Study& study, const StudyCase& values)
{
  std::vector<std::string> changes;
  for (std::size_t k = 0; k < values.size(); ++k)
    changes.push_back(fmt::format("{}={}", study.vary[k].key, values[k].text));
  return changes;
}

fs::path scene_of(const Study& study) { return fs::path(study.file).parent_path() / study.scene.text; }

}  // namespace talus
