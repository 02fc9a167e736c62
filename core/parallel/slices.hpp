#pragma once
// The rows of a file, divided among the ranks that write or read it, in order and in pieces that are equal for any number of ranks.
#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace talus {

/// Rows per piece.  Files are compressed and checked piece by piece, so this number is part of the file format.  Runs with fewer rows are
/// written by the root alone.
inline constexpr std::int64_t rows_of_a_piece = 32768;

/// The rows of one rank: a contiguous range of all rows.
struct Slice {
  std::int64_t first = 0, of_all = 0;
  std::int64_t piece = rows_of_a_piece;
  std::int64_t lead = 0;  ///< rows missing at the beginning of the first piece

  std::int64_t pieces() const noexcept { return of_all == 0 ? 0 : (lead + of_all + piece - 1) / piece; }
  std::int64_t piece_of(std::int64_t row) const noexcept { return (lead + row) / piece; }
  std::int64_t begin_of(std::int64_t number) const noexcept { return std::clamp(number * piece - lead, std::int64_t{0}, of_all); }
  /// Whether `count` rows from `first` on are whole pieces.
  bool is_whole(std::int64_t count) const noexcept
  {
    return count == 0 || (first == begin_of(piece_of(first)) && first + count == begin_of(piece_of(first + count - 1) + 1));
  }
};

/// The distribution of rows among ranks.  The numbers of pieces of any two ranks differ by at most one.
struct Slices {
  std::int64_t rows = 0;
  int ranks = 1;
  std::int64_t piece = rows_of_a_piece;

  std::int64_t begin(int rank) const noexcept { return std::min(rows, (pieces() * rank + ranks - 1) / ranks * piece); }
  std::int64_t end(int rank) const noexcept { return begin(rank + 1); }
  std::size_t size(int rank) const noexcept { return static_cast<std::size_t>(end(rank) - begin(rank)); }
  int rank_of(std::int64_t row) const noexcept { return static_cast<int>(row / piece * ranks / pieces()); }
  Slice of(int rank) const noexcept { return {begin(rank), rows, piece}; }

 private:
  std::int64_t pieces() const noexcept { return (rows + piece - 1) / piece; }
};

}  // namespace talus
