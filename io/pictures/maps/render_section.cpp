#include "io/pictures/maps/render_section.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "io/output/csv.hpp"
#include "io/pictures/maps/render_map_sheet.hpp"

namespace talus::render {

namespace fs = std::filesystem;

void draw_section(const MapSettings& settings, const fs::path& file, const fs::path& png)
{
  struct Curve {
    const char *column, *words;
    Colour colour;
  };
  constexpr std::array curves{Curve{"base", "base", {110, 110, 110}}, Curve{"surface_max", "highest surface", {213, 94, 0}},
                              Curve{"surface", "surface after", {0, 114, 178}}, Curve{"ground", "ground before", {38, 38, 38}}};
  const HistoryTable table = read_history(file);
  const std::vector<Real>& along = table.values.front();
  std::vector<Real> heights;
  for (const Curve& curve : curves)
    if (const auto values = table[curve.column])
      heights.insert(heights.end(), values->begin(), values->end());
  const auto [low, high] = render::range_of(heights);
  const Real margin = 0.06 * (high - low);
  const Shown shown{{along.front(), low - margin}, {along.back(), high + margin}};
  // Without vertical exaggeration if the section is then high enough to be readable.
  const Real aspect = (shown.high[0] - shown.low[0]) / (shown.high[1] - shown.low[1]);
  constexpr Real flattest = 3.5;
  const MapLayout layout = layout_for(std::min(aspect, flattest), settings.size);
  const Place& place = layout.place;
  on_sheet(layout, png, [&](vtkRenderer*, Sheet& sheet) {
    const auto x_of = [&](Real x) { return std::lerp(place.left, place.right, (x - shown.low[0]) / (shown.high[0] - shown.low[0])); };
    const auto y_of = [&](Real y) { return std::lerp(place.bottom, place.top, (y - shown.low[1]) / (shown.high[1] - shown.low[1])); };
    if (const auto ground = table["ground"], surface = table["surface"]; ground && surface)
      for (std::size_t i = 0; i + 1 < along.size(); ++i) {
        const Real sum = (*ground)[i] + (*ground)[i + 1] + (*surface)[i] + (*surface)[i + 1];
        const Real rise = (*surface)[i] + (*surface)[i + 1] - (*ground)[i] - (*ground)[i + 1];
        if (std::isnan(sum) || rise == 0)
          continue;
        sheet.area({{x_of(along[i]), y_of((*ground)[i])},
                    {x_of(along[i + 1]), y_of((*ground)[i + 1])},
                    {x_of(along[i + 1]), y_of((*surface)[i + 1])},
                    {x_of(along[i]), y_of((*surface)[i])}},
                   rise > 0 ? Colour{200, 222, 240} : Colour{245, 222, 205});
      }
    Real y = place.top - 0.9 * sheet.letter();
    for (const Curve& curve : curves) {
      const auto values = table[curve.column];
      if (!values)
        continue;
      std::vector<std::array<Real, 2>> line;
      for (std::size_t i = 0; i <= along.size(); ++i) {
        if (i < along.size() && !std::isnan((*values)[i]))
          line.push_back({x_of(along[i]), y_of((*values)[i])});
        else if (line.size() > 1)
          sheet.line(std::exchange(line, {}), curve.colour);
        else
          line.clear();
      }
      const Real left = place.right + 0.8 * sheet.letter();
      sheet.line({{left, y}, {left + sheet.letter(), y}}, curve.colour);
      sheet.text(curve.words, left + 1.3 * sheet.letter(), y, Side::left, {.size = 0.85});
      y -= 1.4 * sheet.letter();
    }
    add_frame(sheet, place, shown, {"distance [m]", "elevation [m]"});
    const Real exaggeration = (place.height() / (shown.high[1] - shown.low[1])) / (place.width() / (shown.high[0] - shown.low[0]));
    add_title(sheet, layout, settings.title,
              fmt::format("section {}{}", file.stem().string(),
                          exaggeration > 1.01 ? fmt::format(", heights {:.2g} times", exaggeration) : std::string()));
  });
}

}  // namespace talus::render
