#pragma once
// A disk that is full, for one process: files cannot grow beyond a limit while this is alive.
#include <sys/resource.h>

#include <csignal>

namespace talus {

class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes)
  {
    old_handler_ = std::signal(SIGXFSZ, SIG_IGN);  // then write() fails with EFBIG instead of ending the process
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk()
  {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit old_{};
  void (*old_handler_)(int) = SIG_DFL;
};

}  // namespace talus
