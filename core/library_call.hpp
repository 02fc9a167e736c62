#pragma once
// The name of the library call in progress, for the error message of a program that ends inside a library: some libraries crash where
// memory runs out.
#include <string_view>

namespace talus {

/// Sets the text of library_at_work() on this thread while it lives.  Of nested calls the inner one is reported until it ends, then none.
class LibraryCall {
 public:
  /// Takes for example "HDF5", "writing" and a file name.  A long name is truncated.
  LibraryCall(std::string_view library, std::string_view does, std::string_view file) noexcept;
  ~LibraryCall();
  LibraryCall(const LibraryCall&) = delete;
  LibraryCall& operator=(const LibraryCall&) = delete;
};

/// The call of this thread, for example "HDF5, writing out/checkpoints/step_000000100.h5"; empty outside of libraries.  Safe in a signal handler.
std::string_view library_at_work() noexcept;

}  // namespace talus
