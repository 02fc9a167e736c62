#pragma once
// Points of a table that lie at one place.
#include <vector>

#include "core/error.hpp"
#include "io/points/point_table.hpp"
#include "io/points/start_points.hpp"

namespace talus {

/// Drops points that are there already; complains of those with other values.  Each quantity is compared with its own largest value in the
/// table: a stress in Pa would hide every velocity.  `rows` are those of the table, by point.
void merge_equal_points(const PointFile& table, const std::vector<std::size_t>& rows, int dimension, StartPoints& points,
                        std::vector<SceneError>& problems);

}  // namespace talus
