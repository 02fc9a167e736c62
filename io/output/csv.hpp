#pragma once
// Histories: a .csv whose header line names every column with its unit, one row per output time.
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
  std::string unit = {};  ///< empty: a pure number
  friend bool operator==(const CsvColumn&, const CsvColumn&) = default;
};

/// A text as one cell: quoted as RFC 4180 says, line ends become blanks.  A text that a spreadsheet would run gets an apostrophe (csv.cpp).
std::string csv_cell(std::string text);
/// "name [unit]"
std::string csv_heading(const CsvColumn& column);

/// A history while it is being written.  The first column is the time [s], and times increase.
/// Every row reaches the file before append() returns; numbers read back as the same bits.  NaN is an empty entry, which spreadsheets and
/// readers of tables know as "no value".  Disk errors are EnvironmentError.
class HistoryFile {
 public:
  /// Starts a new file, replacing an old one.
  HistoryFile(std::filesystem::path file, std::vector<CsvColumn> columns);
  /// Goes on with a file of the same columns behind its last row with time <= `time` [s]; a row cut short by a kill is dropped.
  /// EnvironmentError if the columns differ.  Without a file there it starts one.
  static HistoryFile resume(std::filesystem::path file, std::vector<CsvColumn> columns, Real time);

  /// values: one per column.
  void append(std::span<const Real> values);
  /// Rows are on the disk when it returns.
  void flush() const;
  Real last_time() const noexcept { return last_time_; }  ///< of the last row [s]; -infinity if there is none
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
  std::optional<std::span<const Real>> operator[](std::string_view name) && = delete;  // the values would be gone
  std::size_t rows() const noexcept { return values.empty() ? 0 : values.front().size(); }
};

/// Reads what HistoryFile writes; an empty entry is NaN.  A last line without its line end (a run was killed) is left out; anything else
/// that is no row of numbers is an EnvironmentError with file and line.
HistoryTable read_history(const std::filesystem::path& file);

}  // namespace talus
