#pragma once
// What is kept of a run, to the last bit: structs by their fields(), particles by their columns, laws by their histories.
#include <fmt/format.h>

#include <cstring>
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

/// Writes a value below `path`.  EnvironmentError.
template <class T>
void save(ArrayWriter& file, const std::string& path, const T& value)
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
  } else if constexpr (std::is_same_v<T, std::vector<Real>>) {
    file.write(path, std::span<const Real>(value));
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
  } else if constexpr (std::is_same_v<T, std::vector<Real>>) {
    value = file.read<Real>(path);
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

/// Every column, in the numbers it is kept in: `rows` tells which of the file are here.  Of arrays without rows there are none in the file
/// either.
template <int D>
void share_columns(const std::string& path, const Particles<D>& particles, const Slice& rows, std::vector<SharedArray>& arrays)
{
  particles.for_each_column([&](std::string_view name, std::string_view unit, const auto& column) {
    using Kept = std::decay_t<decltype(column)>;
    Slice slice = rows;
    if (column.empty())
      slice.of_all = 0;
    const CopyRows copy = [&column](std::size_t from, std::span<std::byte> to) {
      for (; !to.empty(); to = to.subspan(row_bytes<Kept>))
        save_row(column, from++, to.data());
    };
    arrays.push_back({below(path, name), number_kind<typename RowsOf<Kept>::Number>(), RowsOf<Kept>::components, std::string(unit), copy,
                      column.size(), slice});
  });
}
/// Back from the rows from `first` on, `n` of them, column by column by way of memory for one; columns without any in the file have none here.  EnvironmentError.
template <int D>
void recall_columns(const ArrayReader& file, const std::string& path, std::size_t first, std::size_t n, Particles<D>& particles)
{
  particles.for_each_column([&](std::string_view name, std::string_view, auto& column) {
    using Number = typename RowsOf<std::decay_t<decltype(column)>>::Number;
    constexpr int columns = RowsOf<std::decay_t<decltype(column)>>::components;
    const std::string at = below(path, name);
    column.resize(file.rows(at) > 0 ? n : 0);
    std::vector<Number> numbers(column.size() * static_cast<std::size_t>(columns));
    file.read_rows(at, column.empty() ? 0 : first, std::span(numbers), columns);
    const auto bytes = std::as_bytes(std::span(numbers));
    for (std::size_t row = 0; row < column.size(); ++row)
      load_row(bytes.data() + row * row_bytes<std::decay_t<decltype(column)>>, column, row);
  });
}

/// The history of a law, one array a variable.  `rows` as above.
inline void share_history(const std::string& path, const Material& material, const Slice& rows, std::vector<SharedArray>& arrays)
{
  const HistoryRows& history = material.history;
  for (const HistoryVariable& variable : material.law().variables()) {
    const CopyRows copy = [&material, variable](std::size_t from, std::span<std::byte> to) {
      const std::size_t bytes = static_cast<std::size_t>(variable.components) * sizeof(Real);
      for (; !to.empty(); to = to.subspan(bytes))
        std::memcpy(to.data(), &history_value(material, variable, static_cast<Index>(from++)), bytes);
    };
    arrays.push_back({below(path, variable.key), NumberKind::float64, variable.components, std::string(variable.unit), copy,
                      static_cast<std::size_t>(history.size()), rows});
  }
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
