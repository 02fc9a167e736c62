#pragma once
// Unpacks compressed blocks of VTK's files, in silence.
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

namespace talus {

class BlockUnpacker {
 public:
  /// By the name of VTK's class: "vtkLZ4DataCompressor", "vtkZLibDataCompressor" or "vtkLZMADataCompressor".  Throws std::invalid_argument
  /// for another one.
  explicit BlockUnpacker(std::string_view compressor);
  BlockUnpacker(const BlockUnpacker&) = delete;
  BlockUnpacker& operator=(const BlockUnpacker&) = delete;
  ~BlockUnpacker();

  /// Fills `to`; false if the block is damaged or has another size.
  bool operator()(std::span<const char> packed, std::span<std::byte> to);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace talus
