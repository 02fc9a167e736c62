// Functions that writing and reading with HDF5 have in common.
#include "io/checkpoint/hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/error.hpp"

namespace talus::hdf5 {

namespace fs = std::filesystem;

namespace {

// What HDF5 does at exit, which our files do not need as they are closed, ends with a fault if an allocation failed in it before.
// It has to be left out before the first other call of HDF5, which any of its constants is: here, before main().
[[maybe_unused]] const herr_t nothing_at_exit = H5dont_atexit();

}  // namespace

void keep_quiet() noexcept { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

std::string last_words()
{
  std::string words;
  const auto first = [](unsigned, const H5E_error2_t* error, void* to) -> herr_t {
    *static_cast<std::string*>(to) = error->desc == nullptr ? "" : error->desc;
    return 1;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, first, &words);
  return words.empty() ? "HDF5 gives no reason, as where memory runs out" : words;
}

[[noreturn]] void refuse(const fs::path& file, const std::string& path, const std::string& what)
{
  throw EnvironmentError(fmt::format("{}: {} {}", file.string(), path.empty() ? "the file" : path, what));
}

[[noreturn]] void refuse_damaged(const fs::path& file, const std::string& path)
{
  refuse(file, path, fmt::format("is damaged ({})", last_words()));
}

std::vector<std::string> groups_around(const std::string& path)
{
  std::vector<std::string> groups;
  std::size_t begin = 0;
  for (;;) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    const std::string name = path.substr(begin, end - begin);
    if (name.empty() || name == "." || name.find('\0') != std::string::npos)
      throw std::invalid_argument(fmt::format("\"{}\" is no path of names between single slashes", path));
    if (end == path.size())
      return groups;
    groups.push_back(path.substr(0, end));
    begin = end + 1;
  }
}

hid_t type_id(NumberKind kind)
{
  switch (kind) {
    case NumberKind::float64: return type_id<double>();
    case NumberKind::float32: return type_id<float>();
    case NumberKind::int32: return type_id<std::int32_t>();
    case NumberKind::int64: return type_id<std::int64_t>();
    default: return type_id<std::uint8_t>();
  }
}

std::string type_word(hid_t type)
{
  const std::array<std::pair<hid_t, const char*>, 5> words{{{type_id<double>(), "double"},
                                                            {type_id<float>(), "float"},
                                                            {type_id<std::int32_t>(), "int32"},
                                                            {type_id<std::int64_t>(), "int64"},
                                                            {type_id<std::uint8_t>(), "uint8"}}};
  for (const auto& [id, word] : words)
    if (H5Tequal(type, id) > 0)
      return word;
  return H5Tget_class(type) == H5T_STRING ? "text" : "an unknown type";
}

Handle text_type(std::size_t size)
{
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), std::max<std::size_t>(size, 1));  // HDF5 has no text of size zero
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

}  // namespace talus::hdf5
