#pragma once
// What a library of others is doing, for the error message of a program that ends inside of it: some end by a fault where memory runs out.
#include <string_view>

namespace talus {

/// While it lives library_at_work() names it.  Of two, the inner one counts until it is over, and then none.
class LibraryCall {
 public:
  /// Such as "HDF5", "writing" and a file.  A long name is cut.
  LibraryCall(std::string_view library, std::string_view does, std::string_view file) noexcept;
  ~LibraryCall();
  LibraryCall(const LibraryCall&) = delete;
  LibraryCall& operator=(const LibraryCall&) = delete;
};

/// "HDF5, writing out/checkpoints/step_000000100.h5"; nothing outside of all libraries.  Safe in a handler of signals.
std::string_view library_at_work() noexcept;

}  // namespace talus
