// talus drive
#include <fmt/format.h>

#include "app/commands.hpp"
#include "io/reader.hpp"
#include "io/whole_file.hpp"

namespace talus {

namespace {

constexpr std::array<std::string_view, 6> pairs{"xx", "yy", "zz", "xy", "yz", "xz"};

std::string csv_of(const PointTable& table)
{
  std::string text = "time [s]";
  for (const char i : {'x', 'y', 'z'})
    for (const char j : {'x', 'y', 'z'})
      text += fmt::format(",F_{}{}", i, j);
  for (const auto pair : pairs)
    text += fmt::format(",stress_{} [Pa]", pair);
  text += ",p [Pa],q [Pa]";
  for (const std::string& name : table.history_names)
    text += "," + name;
  text += '\n';
  for (const PointRow& row : table.rows) {
    text += fmt::format("{}", row.time);
    for (Index i = 0; i < 9; ++i)
      text += fmt::format(",{}", row.F(i / 3, i % 3));
    for (const Real component : pack(row.stress))
      text += fmt::format(",{}", component);
    text += fmt::format(",{},{}", row.p, row.q);
    for (const Real value : row.history)
      text += fmt::format(",{}", value);
    text += '\n';
  }
  return text;
}

}  // namespace

void drive_law(const std::filesystem::path& file, const std::vector<std::string>& set, const std::optional<std::filesystem::path>& out)
{
  const PointTest test = read_point_path(file, set);
  AnyBatch batch = std::visit([&](const auto& law) { return make_any_batch(law, 0, 1, "point", test.material.where); }, test.material.law);
  const Sym3 start = Eigen::Map<const Sym3>(test.initial_stress.data());
  const std::string text = csv_of(drive(std::move(batch), test.path, unpack(start)));
  if (out)
    write_whole(*out, text);
  else
    fmt::print("{}", text);
}

}  // namespace talus
