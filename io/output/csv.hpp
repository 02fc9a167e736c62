#pragma once
// Histories as .csv: a header line with name and unit of every column, one row per output time.
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct CsvColumn {
  std::string name;
  std::string unit = {};  ///< empty for a pure number
  friend bool operator==(const CsvColumn&, const CsvColumn&) = default;
};

/// A text as one cell: quoted according to RFC 4180, with line ends as blanks.  A text that a spreadsheet would run as a formula gets an
/// apostrophe (csv.cpp).
std::string csv_cell(std::string text);
/// The line with the headings of all columns, such as "name [unit]".
std::string csv_header(std::span<const CsvColumn> columns);

/// A history while it is being written.  The first column is the time [s], and times increase.  Every row reaches the file before append()
/// returns; numbers are bitwise the same when read back.  NaN is written as an empty entry, which spreadsheets read as "no value".  Disk
/// errors are EnvironmentError.
class HistoryFile {
 public:
  /// Starts a new file, replacing an existing one.
  HistoryFile(std::filesystem::path file, std::vector<CsvColumn> columns);
  /// Continues a file of the same columns after its last row with time <= `time` [s]; a truncated row is dropped.  Throws EnvironmentError
  /// if the columns differ.  Starts a new file if there is none.
  static HistoryFile resume(std::filesystem::path file, std::vector<CsvColumn> columns, Real time);

  /// Appends a row with one value per column.
  void append(std::span<const Real> values);
  /// Returns when the rows are on the disk.
  void flush() const;
  Real last_time() const noexcept { return last_time_; }  ///< time of the last row [s]; -infinity without rows
  const std::filesystem::path& path() const noexcept { return path_; }
  std::span<const CsvColumn> columns() const noexcept { return columns_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  HistoryFile(std::filesystem::path file, std::vector<CsvColumn> columns, std::string_view rows);
  void put(std::string_view text);

  std::filesystem::path path_;
  std::vector<CsvColumn> columns_;
  std::unique_ptr<std::FILE, Close> file_;
  Real last_time_ = -std::numeric_limits<Real>::infinity();
};

/// A history as a table: values[column][row].
struct HistoryTable {
  std::vector<CsvColumn> columns;
  std::vector<std::vector<Real>> values;
  /// The column of that name, or nothing.
  std::optional<std::span<const Real>> operator[](std::string_view name) const&;
  std::optional<std::span<const Real>> operator[](std::string_view name) && = delete;  // the span would outlive the values
  std::size_t rows() const noexcept { return values.empty() ? 0 : values.front().size(); }
};

/// Reads what HistoryFile writes; an empty entry is NaN.  A last line without line end (of a killed run) is left out; anything else that is
/// not a row of numbers is an EnvironmentError with file and line.
HistoryTable read_history(const std::filesystem::path& file);

}  // namespace talus
