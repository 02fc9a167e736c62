#pragma once
// Arrays of VTK's XML files in every encoding that VTK writes.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// What the first tag of a file says about all of its arrays.
struct VtkEncoding {
  bool long_headers = false;  ///< numbers of bytes are UInt64, not UInt32
  std::string compressor;     ///< VTK's class; empty for none
};

/// The size of a number [bytes]; nothing for a type that is none of VTK's numbers.
std::optional<std::size_t> vtk_size_of(std::string_view type);

/// Numbers written as text.  Throws EnvironmentError, without the name of a file, for anything that is no number and for another count.
std::vector<Real> numbers_of_text(std::string_view text, std::size_t count);

/// The bytes that a text in base64 stands for, `most` of them at most, up to the first character that does not belong to it; pieces may end
/// with "=".
std::string decoded_base64(std::string_view text, std::size_t most = std::string_view::npos);
/// The bytes of the array with which such a text begins, as many as its header says: the arrays behind it are not decoded.  Throws
/// EnvironmentError, without the name of a file, if the text is shorter.
std::string array_in_base64(std::string_view text, const VtkEncoding& encoding);

/// `count` numbers of that type from bytes that begin with the header of the array.  Nothing is allocated that the bytes could not fill.
/// Throws EnvironmentError, without the name of a file.
std::vector<Real> numbers_of_bytes(std::string_view bytes, const VtkEncoding& encoding, std::string_view type, std::size_t count);

/// How many numbers of that type such bytes say that they hold.  `bytes` may be the header alone; `held` are all of them.  The count is one
/// that so many bytes can hold, or EnvironmentError is thrown.
std::size_t vtk_count_of(std::string_view bytes, std::size_t held, const VtkEncoding& encoding, std::string_view type);
/// The same of an array in base64, of which only the header is decoded.
std::size_t vtk_count_in_base64(std::string_view text, const VtkEncoding& encoding, std::string_view type);

}  // namespace talus
