#pragma once
// Values at points of VTK's XML files that other programs have written.
#include <filesystem>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// One field of such a file.
struct VtkField {
  std::string name;
  int components = 1;
  std::vector<Real> values;                  ///< components * number of items
  std::vector<std::string> component_names;  ///< empty if the file has none
  std::string unit;                          ///< empty for none
};

/// Positions have 3 numbers each; those of cells are the means of their points.
struct VtkPoints {
  std::vector<Real> points, cells;
  std::vector<VtkField> of_points, of_cells;
};

/// Reads a .vtu (UnstructuredGrid) or .vtp (PolyData, points only) with any number of pieces: arrays as text, in base64 or appended (raw or
/// base64), plain or compressed by ZLib, LZ4 or LZMA, with headers of 32 or 64 bits, little-endian.  Texts and arrays of bits are left out.
/// Throws EnvironmentError, with the name of the file and what it has, for everything else.
VtkPoints read_vtk_points(const std::filesystem::path& file);

}  // namespace talus
