#pragma once
// What is kept of a run, to the last bit: structs by their fields(), particles by their columns, laws by their histories.
#include <fmt/format.h>

#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/parallel/threads.hpp"
#include "core/particles.hpp"
#include "io/checkpoint/array_file.hpp"
#include "materials/interface/material.hpp"

namespace talus {

template <class T>
inline constexpr bool is_vector = false;
template <class T, class Allocator>
inline constexpr bool is_vector<std::vector<T, Allocator>> = true;
/// Vectors that are stored as one array.
template <class T>
inline constexpr bool is_row_of_numbers = std::is_same_v<T, std::vector<Real>> || std::is_same_v<T, std::vector<std::int64_t>>;
template <class T>
inline constexpr bool is_variant = false;
template <class... T>
inline constexpr bool is_variant<std::variant<T...>> = true;

namespace detail {
/// What a number is stored as.
template <class T>
using Stored = std::conditional_t<std::is_enum_v<T> || std::is_same_v<T, bool>, std::uint8_t, T>;
}  // namespace detail

/// Paths in the file.
inline std::string below(const std::string& path, std::string_view key) { return path + "/" + std::string(key); }
inline std::string below(const std::string& path, std::size_t i) { return path + "/" + std::to_string(i); }

/// Writes a value below `path`.  Writer: ArrayWriter or KeptArrays.  EnvironmentError.
template <class Writer, class T>
void save(Writer& file, const std::string& path, const T& value)
{
  if constexpr (HasFields<T>) {
    for_each_field<T>([&](const auto& field) { save(file, below(path, field.key), value.*field.member); });
  } else if constexpr (is_variant<T>) {  // the alternative is known to whoever reads it back; one without fields() has nothing to keep
    std::visit(
        [&]<class One>(const One& one) {
          if constexpr (HasFields<One>)
            save(file, path, one);
        },
        value);
  } else if constexpr (std::is_same_v<T, std::string>) {
    file.write(path, std::string_view(value));
  } else if constexpr (is_row_of_numbers<T>) {
    file.write(path, std::span<const typename T::value_type>(value));
  } else if constexpr (is_vector<T>) {
    const auto count = static_cast<std::int64_t>(value.size());
    file.write(below(path, "count"), std::span(&count, 1));
    for (std::size_t i = 0; i < value.size(); ++i)
      save(file, below(path, i), value[i]);
  } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
    const auto stored = static_cast<detail::Stored<T>>(value);
    file.write(path, std::span(&stored, 1));
  } else {
    file.write(path, std::span<const Real>(value.data(), static_cast<std::size_t>(value.size())));
  }
}
/// Reads it back.  EnvironmentError: it is not there, or of another kind.
template <class T>
void load(const ArrayReader& file, const std::string& path, T& value)
{
  if constexpr (HasFields<T>) {
    for_each_field<T>([&](const auto& field) { load(file, below(path, field.key), value.*field.member); });
  } else if constexpr (is_variant<T>) {
    std::visit(
        [&]<class One>(One& one) {
          if constexpr (HasFields<One>)
            load(file, path, one);
        },
        value);
  } else if constexpr (std::is_same_v<T, std::string>) {
    value = file.text(path);
  } else if constexpr (is_row_of_numbers<T>) {
    value = file.read<typename T::value_type>(path);
  } else if constexpr (is_vector<T>) {
    std::int64_t count = 0;
    load(file, below(path, "count"), count);
    const auto n = static_cast<std::size_t>(count);
    for (std::size_t i = 0; i < n; ++i) {  // one by one: nothing is allocated on the word of a file
      if (i == value.size())
        value.emplace_back();
      load(file, below(path, i), value[i]);
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

/// Adds all columns; `rows` gives the position of the rows of this rank in the file.  A column without rows has none in the file either.
template <int D>
void share_columns(const std::string& path, const Particles<D>& particles, const Slice& rows, std::vector<SharedArray>& arrays)
{
  particles.for_each_column([&](std::string_view name, std::string_view unit, const auto& column) {
    using Kept = RowsOf<std::decay_t<decltype(column)>>;
    Slice slice = rows;
    if (column.empty())
      slice.of_all = 0;
    arrays.push_back({below(path, name), number_kind<typename Kept::Number>(), Kept::components, std::string(unit),
                      reinterpret_cast<const std::byte*>(numbers_of(column, 0)), column.size(), row_bytes<std::decay_t<decltype(column)>>,
                      slice});
  });
}
/// Reads `n` rows from row `first` on; a column without rows in the file gets none.  EnvironmentError.
template <int D>
void recall_columns(const ArrayReader& file, const std::string& path, std::size_t first, std::size_t n, Particles<D>& particles)
{
  particles.for_each_column([&](std::string_view name, std::string_view, auto& column) {
    constexpr int components = RowsOf<std::decay_t<decltype(column)>>::components;
    const std::string at = below(path, name);
    column.resize(file.rows(at) > 0 ? n : 0);
    file.read_rows(at, column.empty() ? 0 : first, std::span(numbers_of(column, 0), column.size() * components), components);
  });
}

/// The history of a law, one array a variable.  `rows` as above.
inline void share_history(const std::string& path, const Material& material, const Slice& rows, std::vector<SharedArray>& arrays)
{
  const HistoryRows& history = material.history;
  for (const HistoryVariable& variable : material.law().variables())
    arrays.push_back({below(path, variable.key), NumberKind::float64, variable.components, std::string(variable.unit),
                      history.size() > 0 ? reinterpret_cast<const std::byte*>(&history_value(material, variable, 0)) : nullptr,
                      static_cast<std::size_t>(history.size()), history.row_bytes(), rows});
}
/// Back from the rows from `first` on, of a material whose range is right already, where the file has `n` of all ranks.
inline void recall_history(const ArrayReader& file, const std::string& path, std::size_t first, std::size_t n, Material& material)
{
  material.history.resize(material.size());
  for (const HistoryVariable& variable : material.law().variables()) {
    const int columns = variable.components;
    const std::string at = below(path, variable.key);
    if (const std::size_t there = file.rows(at); there != n)
      throw EnvironmentError(fmt::format("{} has {} rows, not {}", at, there, n));
    std::vector<Real> values(static_cast<std::size_t>(material.size() * columns));
    file.read_rows<Real>(at, first, values, columns);
    parallel_for(material.size(), [&](Index i) {
      for (int c = 0; c < columns; ++c)
        history_value(material, variable, i, c) = values[static_cast<std::size_t>(i * columns + c)];
    });
  }
}

}  // namespace talus
