#pragma once
// Columns of history.csv: who gives which, and what they are called.
#include "io/output/csv.hpp"
#include "io/scene/scene_output.hpp"
#include "mesh/conditions/conditions.hpp"

namespace talus {

/// Of every history: time, step, dt, stage; mass, momentum, angular momentum, centre of mass; energies; the residual.
std::vector<CsvColumn> common_columns(int dimension);
/// Of a wall: its mean force on the bodies since the row before.
std::vector<CsvColumn> reaction_columns(const std::string& wall, int dimension);
/// Of a point: position, displacement (u), velocity (v) and stress (s).
std::vector<CsvColumn> columns_of(const PointSpec& point, int dimension);
std::vector<CsvColumn> columns_of(const FrontSpec& front);
/// Of what bodies do to a wall.
std::vector<CsvColumn> columns_of(const WallSpec& wall, int dimension);
std::vector<CsvColumn> columns_of(const MovedSpec& moved);
/// Of a body: mass, momentum, kinetic energy, plastic work, and the mean force of walls and other bodies on it since the row before.
std::vector<CsvColumn> body_columns(const std::string& body, int dimension);

/// Walls are called by the group that they are on; the second on a group is `<group>_2`, and so on.
std::vector<std::string> wall_names(const std::vector<BoundaryOptions>& boundaries);

}  // namespace talus
