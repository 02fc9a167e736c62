#pragma once
// Functions that writing and reading with HDF5 have in common.  For io/checkpoint/array_*.cpp only; others use
// io/checkpoint/array_file.hpp.
#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/checkpoint/array_file.hpp"

namespace talus::hdf5 {

// Names of the attributes of an array.
inline constexpr auto digest_name = "digest";
inline constexpr auto pieces_name = "pieces";
inline constexpr auto unit_name = "unit";

/// The owner of an HDF5 object, which it closes.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close closer) noexcept : id_(id), close_(closer) {}
  ~Handle()
  {
    if (is_open())
      close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  bool is_open() const noexcept { return id_ >= 0; }
  hid_t id() const noexcept { return id_; }
  /// Closes the object.  False if that fails: HDF5 may write as late as here.
  bool close() noexcept { return close_(std::exchange(id_, H5I_INVALID_HID)) >= 0; }

 private:
  hid_t id_;
  Close close_;
};

/// Stops HDF5 from printing errors; they are thrown instead.
void keep_quiet() noexcept;

/// The innermost error message of HDF5.
std::string last_words();

/// Throws EnvironmentError with file, path and reason.
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& path, const std::string& what);
/// Throws EnvironmentError with file, path and the error message of HDF5.
[[noreturn]] void refuse_damaged(const std::filesystem::path& file, const std::string& path);

/// The groups that contain a path, outermost first: "a", "a/b" for "a/b/c".  Throws std::invalid_argument if it is not a valid path.
std::vector<std::string> groups_around(const std::string& path);

template <class T>
hid_t type_id()
{
  if constexpr (std::is_same_v<T, double>)
    return H5T_NATIVE_DOUBLE;
  else if constexpr (std::is_same_v<T, float>)
    return H5T_NATIVE_FLOAT;
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return H5T_NATIVE_INT32;
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return H5T_NATIVE_INT64;
  else {
    static_assert(std::is_same_v<T, std::uint8_t>);
    return H5T_NATIVE_UINT8;
  }
}
hid_t type_id(NumberKind kind);
/// The name of a type in messages: "double", "text", ...
std::string type_word(hid_t type);
/// The type of a text with `size` bytes.
Handle text_type(std::size_t size);

}  // namespace talus::hdf5
