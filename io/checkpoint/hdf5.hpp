#pragma once
// What writing and reading by HDF5 have in common.  For io/array_*.cpp: others see io/checkpoint/array_file.hpp.
#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/checkpoint/array_file.hpp"

namespace talus::hdf5 {

// Attributes of an array.
inline constexpr auto digest_name = "digest";
inline constexpr auto pieces_name = "pieces";
inline constexpr auto unit_name = "unit";

/// What HDF5 has opened, closed at its end.
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
  /// Errors of what is written as late as this.
  bool close() noexcept { return close_(std::exchange(id_, H5I_INVALID_HID)) >= 0; }

 private:
  hid_t id_;
  Close close_;
};

/// HDF5 prints no errors from now on: they are thrown.
void keep_quiet() noexcept;

/// What went wrong, from the innermost of HDF5's messages.
std::string last_words();

/// EnvironmentError: file, path, what is the matter with it.
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& path, const std::string& what);
/// The same, in the words of HDF5.
[[noreturn]] void refuse_damaged(const std::filesystem::path& file, const std::string& path);

/// The groups around a path, outermost first: "a", "a/b" of "a/b/c".  std::invalid_argument: it is no path.
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
/// "double", "text", ...
std::string type_word(hid_t type);
/// Of so many bytes.
Handle text_type(std::size_t size);

}  // namespace talus::hdf5
