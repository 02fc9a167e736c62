#pragma once
// The block `outputs` of a scene.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "io/scene/scene_runout.hpp"

namespace talus {

struct ParticleOutputSpec {
  Real every{};
  std::vector<std::string> fields_wanted{"velocity", "displacement", "stress"};
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("every", &ParticleOutputSpec::every, positive, "s", "time between files"),
                      optional("fields", &ParticleOutputSpec::fields_wanted, any, "-",
                               "fields of the table below, and history variables of the laws in the scene")};
  }
};

struct MeshOutputSpec {
  Real every{};
  std::vector<std::string> fields_wanted{"mass", "velocity"};
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("every", &MeshOutputSpec::every, positive, "s", "time between files"),
                      optional("fields", &MeshOutputSpec::fields_wanted, any, "-", "nodal fields of the table below")};
  }
};

/// Tracks the particle that is nearest to a position at the start.
struct PointSpec {
  std::string name;
  std::vector<Real> at;
  std::string body;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("name", &PointSpec::name, any, "-", "prefix of its columns"),
                      required("at", &PointSpec::at, any, "m", "place at the start; the nearest particle is followed"),
                      optional("body", &PointSpec::body, any, "-", "only particles of this body; default any")};
  }
};

enum class Direction : std::uint8_t { x_plus, x_minus, y_plus, y_minus, z_plus, z_minus };
constexpr std::array<std::string_view, 6> enum_names(Direction) { return {"+x", "-x", "+y", "-y", "+z", "-z"}; }

/// The farthest position of mass in a direction: run-out, crest height.
struct FrontSpec {
  std::string name;
  Direction direction{};
  Real mass_share = 0.99;
  std::string body;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("name", &FrontSpec::name, any, "-", "name of the column"),
                      required_choice("direction", &FrontSpec::direction, "along which the mass is measured"),
                      optional("mass_share", &FrontSpec::mass_share, within(0, 1), "-",
                               "coordinate below which this share of the mass lies; 1 is the outermost particle"),
                      optional("body", &FrontSpec::body, any, "-", "only this body; default all")};
  }
};

/// The action of bodies on a wall.
struct WallSpec {
  std::string on;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("on", &WallSpec::on, any, "-", "the wall, by the group of its boundary; the second on a group is GROUP_2")};
  }
};

/// The displacement of mass.
struct MovedSpec {
  std::string name;
  Real mass_share = 0.99;
  std::string body;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{required("name", &MovedSpec::name, any, "-", "name of the column"),
                      optional("mass_share", &MovedSpec::mass_share, within(0, 1), "-",
                               "length of displacement that this share of the mass does not exceed; 1 is the particle that moved most"),
                      optional("body", &MovedSpec::body, any, "-", "only this body; default all")};
  }
};

struct HistoryOutputSpec {
  Real every{};
  std::vector<PointSpec> points;
  std::vector<FrontSpec> fronts;
  std::vector<WallSpec> walls;
  std::vector<MovedSpec> moved;
  std::vector<std::string> bodies;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        required("every", &HistoryOutputSpec::every, positive, "s",
                 "time between rows; energies, momenta, mass, residual and reactions are always there"),
        optional_list("points", &HistoryOutputSpec::points,
                      "material points whose position, displacement, velocity and stress are written"),
        optional_list("fronts", &HistoryOutputSpec::fronts, "extents of the mass"),
        optional_list("walls", &HistoryOutputSpec::walls,
                      "walls whose push, shear, area in touch, pressure and point of attack are written"),
        optional_list("moved", &HistoryOutputSpec::moved, "how far the mass has moved"),
        optional("bodies", &HistoryOutputSpec::bodies, any, "-",
                 "bodies whose mass, momentum, kinetic energy, plastic work and the force of walls and other bodies on them are "
                 "written")};
  }
};

/// The times of checkpoints, from which a run can be resumed.
struct CheckpointSpec {
  std::optional<Real> every;
  std::optional<Index> steps;
  Real wall_time = 900;
  Index keep = 2;
  bool at_end = false;
  static constexpr auto fields()
  {
    return std::tuple{optional("every", &CheckpointSpec::every, positive, "s", "simulated time between checkpoints; default never"),
                      optional("steps", &CheckpointSpec::steps, positive, "-", "steps between checkpoints; default never"),
                      optional("wall_time", &CheckpointSpec::wall_time, positive, "s", "time on the clock between checkpoints"),
                      optional("keep", &CheckpointSpec::keep, at_least(1), "-", "so many are kept, the last ones"),
                      optional("at_end", &CheckpointSpec::at_end, any, "-",
                               "one more at the end of the run, for other scenes to begin with: see initial")};
  }
};

/// The defaults of `talus render`.
struct PictureSpec {
  std::string field = "displacement";
  std::vector<Real> range, view{0.4, -1, 0.5}, up;
  bool mesh = true;
  static constexpr auto fields()
  {
    return std::tuple{
        optional("field", &PictureSpec::field, any, "-", "particle field that colours the particles; vectors by their length"),
        optional("range", &PictureSpec::range, any, "-", "[low, high] of the colour map; default the range of the last frame"),
        optional("view", &PictureSpec::view, any, "-", "3-D: direction from the scene to the camera"),
        optional("up", &PictureSpec::up, any, "-", "3-D: direction that points up in the picture; default against gravity"),
        optional("mesh", &PictureSpec::mesh, any, "-", "draw the outline of the mesh")};
  }
  void check(std::vector<std::string>& problems) const;
};

struct OutputSpec {
  std::optional<ParticleOutputSpec> particles;
  std::optional<MeshOutputSpec> mesh;
  std::optional<HistoryOutputSpec> history;
  std::optional<RunoutSpec> runout;
  CheckpointSpec checkpoint;
  PictureSpec picture;
  static constexpr auto fields()
  {
    return std::tuple{
        group("particles", &OutputSpec::particles, "particle files (.vtp) for ParaView, with a .pvd series"),
        group("mesh", &OutputSpec::mesh, "mesh files (.vtu) with nodal fields"),
        group("history", &OutputSpec::history, "history.csv"),
        group("runout", &OutputSpec::runout, "runout.csv and maps: how far, how thick and how fast what has moved gets"),
        optional("checkpoint", &OutputSpec::checkpoint, any, "-",
                 "the state of the run, from which talus run --resume goes on; one more is written when the run is told to stop"),
        optional("picture", &OutputSpec::picture, any, "-", "how talus render draws the run")};
  }
};

}  // namespace talus
