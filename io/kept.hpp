#pragma once
// What is kept of a run, to the last bit: structs by their fields(), particles by their columns, laws by their histories.
#include <string>
#include <type_traits>
#include <vector>

#include "io/array_file.hpp"
#include "materials/batch.hpp"

namespace talus {

template <class T>
inline constexpr bool is_vector = false;
template <class T, class Allocator>
inline constexpr bool is_vector<std::vector<T, Allocator>> = true;

namespace detail {
/// What a number is stored as.
template <class T>
using Stored = std::conditional_t<std::is_enum_v<T> || std::is_same_v<T, bool>, std::uint8_t, T>;
/// Numbers of a row: a number, vector or tensor.
template <class Row>
struct RowOf {
  using Number = Row;
  static constexpr int columns = 1;
};
template <class N, int R, int C, int options>
struct RowOf<Eigen::Matrix<N, R, C, options>> {
  using Number = N;
  static constexpr int columns = R * C;
};
}  // namespace detail

/// Paths in the file.
inline std::string below(const std::string& path, std::string_view key) { return path + "/" + std::string(key); }
inline std::string below(const std::string& path, std::size_t i) { return path + "/" + std::to_string(i); }

/// Writes a value below `path`.  EnvironmentError.
template <class T>
void keep(ArrayWriter& file, const std::string& path, const T& value)
{
  if constexpr (HasFields<T>) {
    for_each_field<T>([&](const auto& field) { keep(file, below(path, field.key), value.*field.member); });
  } else if constexpr (std::is_same_v<T, std::string>) {
    file.write(path, std::string_view(value));
  } else if constexpr (is_vector<T>) {
    const auto count = static_cast<std::int64_t>(value.size());
    file.write(below(path, "count"), std::span(&count, 1));
    for (std::size_t i = 0; i < value.size(); ++i)
      keep(file, below(path, i), value[i]);
  } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
    const auto stored = static_cast<detail::Stored<T>>(value);
    file.write(path, std::span(&stored, 1));
  } else {
    file.write(path, std::span<const Real>(value.data(), static_cast<std::size_t>(value.size())));
  }
}
/// Reads it back.  EnvironmentError: it is not there, or of another kind.
template <class T>
void recall(const ArrayReader& file, const std::string& path, T& value)
{
  if constexpr (HasFields<T>) {
    for_each_field<T>([&](const auto& field) { recall(file, below(path, field.key), value.*field.member); });
  } else if constexpr (std::is_same_v<T, std::string>) {
    value = file.text(path);
  } else if constexpr (is_vector<T>) {
    std::int64_t count = 0;
    recall(file, below(path, "count"), count);
    const auto n = static_cast<std::size_t>(count);
    for (std::size_t i = 0; i < n; ++i) {  // one by one: nothing is allocated on the word of a file
      if (i == value.size())
        value.emplace_back();
      recall(file, below(path, i), value[i]);
    }
    value.resize(n);
  } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
    detail::Stored<T> stored{};
    file.read_into(path, std::span(&stored, 1));
    value = static_cast<T>(stored);
  } else {
    file.read_into(path, std::span<Real>(value.data(), static_cast<std::size_t>(value.size())));
  }
}

/// Every column, in the numbers it is kept in.
template <int D>
void keep(ArrayWriter& file, const std::string& path, const Particles<D>& particles)
{
  particles.for_each_column([&](std::string_view name, std::string_view unit, const auto& rows) {
    using Row = detail::RowOf<std::decay_t<decltype(rows[0])>>;
    const auto* const first = reinterpret_cast<const typename Row::Number*>(rows.data());
    file.write(below(path, name), std::span(first, rows.size() * Row::columns), Row::columns, std::string(unit));
  });
}
template <int D>
void recall(const ArrayReader& file, const std::string& path, Particles<D>& particles)
{
  particles.for_each_column([&](std::string_view name, std::string_view, auto& rows) {
    using Row = detail::RowOf<std::decay_t<decltype(rows[0])>>;
    const std::string at = below(path, name);
    rows.resize(file.rows(at));
    auto* const first = reinterpret_cast<typename Row::Number*>(rows.data());
    file.read_into(at, std::span(first, rows.size() * Row::columns), Row::columns);
  });
}

/// Histories of a law, one array a variable.
inline void keep(ArrayWriter& file, const std::string& path, const AnyBatch& batch)
{
  for_each_history(batch, [&](std::string_view key, std::string_view unit, std::string_view, const auto& column) {
    constexpr int columns = std::decay_t<decltype(column)>::components;
    std::vector<Real> values(static_cast<std::size_t>(column.size() * columns));
    parallel_for(column.size(), [&](Index i) {
      for (int c = 0; c < columns; ++c)
        values[static_cast<std::size_t>(i * columns + c)] = column.component(i, c);
    });
    file.write<Real>(below(path, key), values, columns, std::string(unit));
  });
}
/// Of a batch whose range is right already.
inline void recall(const ArrayReader& file, const std::string& path, AnyBatch& batch)
{
  std::visit([](auto& typed) { typed.history.resize(static_cast<std::size_t>(typed.size())); }, batch);
  for_each_history(batch, [&](std::string_view key, std::string_view, std::string_view, const auto& column) {
    constexpr int columns = std::decay_t<decltype(column)>::components;
    std::vector<Real> values(static_cast<std::size_t>(column.size() * columns));
    file.read_into<Real>(below(path, key), values, columns);
    parallel_for(column.size(), [&](Index i) {
      for (int c = 0; c < columns; ++c)
        column.component(i, c) = values[static_cast<std::size_t>(i * columns + c)];
    });
  });
}

}  // namespace talus
