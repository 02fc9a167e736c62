#pragma once
// A small file of arrays.
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "io/checkpoint/array_file.hpp"

namespace talus::array_file_test {

/// A small file with something of every kind, many names, and words that the checksum of HDF5 takes for one another.
inline void write_small(const std::filesystem::path& file)
{
  const std::vector<double> x{0.0, -0.0, 1.0 / 3, std::numeric_limits<double>::quiet_NaN(), 5e-324, 7.0};
  const std::vector<std::int32_t> cells{0, -1, -1, 0, 7, 1 << 20};
  ArrayWriter writer(file);
  writer.write("scene", "title: a small one\n");
  writer.write<double>("soil/x", x, 3, "m");
  writer.write<std::int32_t>("soil/cell", cells);
  writer.write<std::int64_t>("soil/id", std::vector<std::int64_t>{1, 2, -3});
  writer.write<float>("soil/old", std::vector<float>{0.5F, -1.0F}, 1, "Pa");
  writer.write<std::uint8_t>("soil/on", std::vector<std::uint8_t>{0, 1, 255});
  writer.write<double>("soil/none", {}, 3);
  for (int i = 0; i < 9; ++i)
    writer.write<double>("many/" + std::to_string(i), std::vector<double>{0.1 * i});
  writer.close();
}

}  // namespace talus::array_file_test
