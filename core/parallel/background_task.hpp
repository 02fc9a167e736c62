#pragma once
// Runs a function on a second thread while the caller continues.
#include <atomic>
#include <exception>
#include <functional>
#include <thread>
#include <utility>

#include "core/parallel/threads.hpp"

namespace talus {

/// At most one piece of work at a time, on one thread; parallel loops in it have that thread only.
class BackgroundTask {
 public:
  BackgroundTask() = default;
  BackgroundTask(const BackgroundTask&) = delete;
  BackgroundTask& operator=(const BackgroundTask&) = delete;
  /// Returns when the work is finished; an exception of it is lost.
  ~BackgroundTask() { join(); }

  /// Starts the work, after wait().  If no thread can be created, the work is done before start() returns, with all threads of the caller;
  /// its exception is still thrown by wait().
  void start(std::function<void()> work)
  {
    wait();
    work_ = std::move(work);
    done_ = false;
    const auto run = [this]() noexcept {
      try {
        work_();
      } catch (...) {
        error_ = std::current_exception();
      }
      work_ = nullptr;  // releases what it holds
      done_ = true;
    };
    try {
      thread_ = std::thread([run] {
        set_threads(1);
        run();
      });
    } catch (const std::exception&) {  // no thread, or no memory for one
      run();
    }
  }

  /// Whether wait() would return, or throw, at once.
  bool is_done() const noexcept { return done_; }

  /// Returns when the work is finished.  Throws its exception, once.
  void wait()
  {
    join();
    if (error_)
      std::rethrow_exception(std::exchange(error_, nullptr));
  }

 private:
  void join() noexcept
  {
    if (thread_.joinable())
      thread_.join();
  }

  std::function<void()> work_;
  std::exception_ptr error_;
  std::atomic<bool> done_ = true;
  std::thread thread_;
};

}  // namespace talus
