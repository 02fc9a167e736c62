#pragma once
// Arrays and texts that are kept in memory until a file is written.
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/checkpoint/array_file.hpp"

namespace talus {

/// Copies what is written to it, in order, so that a thread of its own can write the file while the originals change.
class KeptArrays {
 public:
  /// As the functions of ArrayWriter, which check the arguments in write_to().
  template <class T>
  void write(const std::string& path, std::span<const T> values, int columns = 1, const std::string& unit = "")
  {
    calls_.push_back([path, copy = std::vector<T>(values.begin(), values.end()), columns, unit](ArrayWriter& file) {
      file.write(path, std::span<const T>(copy), columns, unit);
    });
  }
  void write(const std::string& path, std::string_view text)
  {
    calls_.push_back([path, copy = std::string(text)](ArrayWriter& file) { file.write(path, std::string_view(copy)); });
  }

  /// Writes everything to a file.  Errors as for ArrayWriter.
  void write_to(ArrayWriter& file) const
  {
    for (const auto& call : calls_)
      call(file);
  }

 private:
  std::vector<std::function<void(ArrayWriter&)>> calls_;
};

}  // namespace talus
