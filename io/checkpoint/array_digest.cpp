// Digests of arrays, by pieces of rows.
#include "io/checkpoint/array_digest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/parallel/threads.hpp"

namespace talus {

std::uint64_t digest_of(const std::string& path, const std::string& type, const Extents& shape, const std::string& unit)
{
  const std::string meaning = fmt::format("{}\n{}\n{} x {}\n{}", path, type, shape.rows, shape.columns, unit);
  return digest_of(std::as_bytes(std::span(meaning)), 0);
}

void pack(const SharedArray& array, std::size_t from, std::size_t row_bytes, std::span<std::byte> to)
{
  const std::byte* row = array.first + from * array.stride;
  for (; !to.empty(); to = to.subspan(row_bytes), row += array.stride)
    std::memcpy(to.data(), row, row_bytes);
}

std::vector<std::uint64_t> digests_of(const SharedArray& array, std::size_t number_bytes, std::uint64_t meaning)
{
  if (!array.slice.is_whole(static_cast<std::int64_t>(array.rows)))
    throw std::invalid_argument(fmt::format("{}: {} rows from {} on are no whole pieces", array.path, array.rows, array.slice.first));
  if (array.rows == 0)
    return {};
  constexpr std::size_t at_once = Digest::block;  // so many rows are whole blocks, however long
  const std::size_t row_bytes = static_cast<std::size_t>(array.columns) * number_bytes;
  const Slice& slice = array.slice;
  const std::int64_t begin = slice.piece_of(slice.first), end = slice.piece_of(slice.first + static_cast<std::int64_t>(array.rows) - 1) + 1;
  std::vector<std::uint64_t> digests(static_cast<std::size_t>(end - begin));
  const bool is_packed = array.stride == row_bytes;
  std::vector<std::vector<std::byte>> room(std::min(static_cast<std::size_t>(threads()), digests.size()),
                                           std::vector<std::byte>(is_packed ? 0 : at_once * row_bytes));
  parallel_for(static_cast<Index>(room.size()), [&](Index t) {
    const auto thread = static_cast<std::size_t>(t);
    for (std::size_t i = thread; i < digests.size(); i += room.size()) {
      const std::int64_t number = begin + static_cast<std::int64_t>(i);
      auto row = static_cast<std::size_t>(slice.begin_of(number) - slice.first);
      const auto last = static_cast<std::size_t>(slice.begin_of(number + 1) - slice.first);
      Digest digest(meaning, (last - row) * row_bytes);
      if (is_packed)
        digest.add({array.first + row * row_bytes, (last - row) * row_bytes});
      for (; !is_packed && row < last; row += at_once) {
        const auto some = std::span(room[thread]).first(std::min(at_once, last - row) * row_bytes);
        pack(array, row, row_bytes, some);
        digest.add(some);
      }
      digests[i] = digest.value();
    }
  });
  return digests;
}

}  // namespace talus
