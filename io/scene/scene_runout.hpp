#pragma once
// The block `outputs.runout` of a scene: run-out, thickness, speed, and maps of them.
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"

namespace talus {

/// A line in the plan along which the ground before, the surface after and the moving material are written.
struct SectionSpec {
  std::string name;
  std::vector<std::vector<Real>> along;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("name", &SectionSpec::name, any, "-", "of its file: sections/NAME.csv"),
        required("along", &SectionSpec::along, any, "m",
                 "corners of the line, [east, north] where the mesh lies on a map, otherwise in the coordinates of the scene")};
  }
  void check(std::vector<std::string>& problems) const;
};

struct RunoutSpec {
  Real every{};
  std::vector<std::string> bodies, eroded;
  std::optional<Real> cell, threshold, moved;
  Real mass_share = 0.99;
  std::optional<Real> frames_every;
  bool csv = false;
  std::vector<SectionSpec> sections;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("every", &RunoutSpec::every, positive, "s", "time between looks: rows of runout.csv, and how finely arrival is known"),
        optional("bodies", &RunoutSpec::bodies, any, "-", "whose particles count; default all"),
        optional("moved", &RunoutSpec::moved, non_negative, "m",
                 "a particle displaced by less does not count: it is ground still; default one cell of the maps"),
        optional("cell", &RunoutSpec::cell, positive, "m",
                 "cells of the maps are at most this large, so that a whole number of them fits the mesh; default the mean size of the "
                 "cells of the mesh"),
        optional("threshold", &RunoutSpec::threshold, positive, "m",
                 "a place is reached where so much lies or flows; default a tenth of a cell of the maps"),
        optional("mass_share", &RunoutSpec::mass_share, within(0, 1), "-",
                 "the front is where this share of what has moved, counted from the crown, ends; 1 is the outermost particle"),
        optional("eroded", &RunoutSpec::eroded, any, "-",
                 "bodies among them that are ground at first: what moves of them is entrained, and map erosion shows from where"),
        optional("frames_every", &RunoutSpec::frames_every, positive, "s",
                 "time between maps of the thickness, for talus map --movie; default none"),
        optional("csv", &RunoutSpec::csv, any, "-", "maps as tables too, beside the GeoTIFF files"),
        optional_list("sections", &RunoutSpec::sections, "3-D: lines over the plan; in 2-D the plane itself is written")};
  }
};

}  // namespace talus
