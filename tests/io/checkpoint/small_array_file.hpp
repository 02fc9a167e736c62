#pragma once
// A small file of arrays.
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "io/checkpoint/array_file.hpp"

namespace talus::array_file_test {

/// Something of every kind, many names, and words that the checksum of HDF5 takes for one another.
template <class Writer>
void write_small_to(Writer& writer)
{
  const std::vector<double> x{0.0, -0.0, 1.0 / 3, std::numeric_limits<double>::quiet_NaN(), 5e-324, 7.0};
  const std::vector<std::int32_t> cells{0, -1, -1, 0, 7, 1 << 20};
  writer.write("scene", "title: a small one\n");
  writer.template write<double>("soil/x", x, 3, "m");
  writer.template write<std::int32_t>("soil/cell", cells);
  writer.template write<std::int64_t>("soil/id", std::vector<std::int64_t>{1, 2, -3});
  writer.template write<float>("soil/old", std::vector<float>{0.5F, -1.0F}, 1, "Pa");
  writer.template write<std::uint8_t>("soil/on", std::vector<std::uint8_t>{0, 1, 255});
  writer.template write<double>("soil/none", {}, 3);
  for (int i = 0; i < 9; ++i)
    writer.template write<double>("many/" + std::to_string(i), std::vector<double>{0.1 * i});
}
/// A small file of that.
inline void write_small(const std::filesystem::path& file)
{
  ArrayWriter writer(file);
  write_small_to(writer);
  writer.close();
}

}  // namespace talus::array_file_test
