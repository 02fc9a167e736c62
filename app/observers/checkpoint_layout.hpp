#pragma once
// Where the parts of a state stand in a checkpoint, for writing and reading.
#include "core/parallel/slices.hpp"
#include "io/checkpoint/serialize.hpp"

namespace talus {

/// The version of the format; it increases with every change of the contents.
inline constexpr std::int64_t checkpoint_format = 14;

inline std::string history_of(std::size_t body) { return below("laws/history", body); }

/// The rows of a body among the rows of a file: `here` counts from the row `rows.first` of the file.
inline Slice rows_of_body(const Body& in_file, const Body& here, const Slice& rows)
{
  const std::int64_t first = here.size() > 0 ? rows.first + here.begin - in_file.begin : 0;
  return {first, in_file.size(), rows.piece, in_file.begin % rows.piece};
}

/// Parts of a state whose rows are written as arrays instead of fields.
template <class Part>
constexpr bool is_of_particles =
    std::is_same_v<Part, Particles<2>> || std::is_same_v<Part, Particles<3>> || std::is_same_v<Part, std::vector<Material>>;

}  // namespace talus
