#include "app/commands/fos/fos_pictures.hpp"

#include <fmt/format.h>

#include "app/commands/pictures/picture_commands.hpp"
#include "io/files/atomic_file.hpp"
#include "io/pictures/settings/launch_render.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

void draw_curve(const FosPlan& plan, const Bracket& bracket, const std::string& y, const std::string& name,
                const std::vector<std::string>& more)
{
  const fs::path chart = plan.folder / name;
  std::vector<std::string> words{(plan.folder / "fos_curve.csv").string(), "--title", plan.spec.title, "--x", "factor", "--y", y};
  words.insert(words.begin(), "chart");
  for (const auto& [verdict, factor] : {std::pair("holds", *bracket.low), std::pair("fails", *bracket.high)})
    words.insert(words.end(), {"--upright", fmt::format("{} at {:.6g}", verdict, factor), fmt::format("{}", factor)});
  words.insert(words.end(), {"--curve", "trials", "--marks", "--out", chart.string()});
  words.insert(words.end(), more.begin(), more.end());
  launch_render(words);
  fmt::print("{}\n", chart.string());
}

}  // namespace

void draw_fos(const FosPlan& plan, std::span<const FosTrial> trials, const Bracket& bracket)
{
  std::string table = "factor,displacement [m],growth [-]\n";
  const FosTrial* failing = nullptr;
  for (const FosTrial& trial : trials) {
    if (!trial.motion)
      continue;
    table += fmt::format("{},{},{}\n", trial.factor, trial.motion->moved, trial.motion->growth);
    if (trial.verdict == Verdict::fails && failing == nullptr)
      failing = &trial;
  }
  write_whole(plan.folder / "fos_curve.csv", table);
  draw_curve(plan, bracket, "displacement [m]", "fos.png", {"--log"});
  draw_curve(plan, bracket, "growth [-]", "fos_growth.png", {"--level", "limit", fmt::format("{}", plan.criterion.growth)});
  if (failing == nullptr)
    return;
  const fs::path picture = plan.folder / "mechanism.png";
  RenderOptions render;
  render.folder = plan.folder / fmt::format("trial_{}", failing->factor);
  render.words = {"--out", picture.string(), "--field", plan.keeps_strain ? "plastic_strain" : "displacement"};
  render_results(render);
}

}  // namespace talus
