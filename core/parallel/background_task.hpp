#pragma once
// Runs a function on a second thread while the caller continues.
#include <atomic>
#include <exception>
#include <functional>
#include <future>
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
    promise_ = {};
    result_ = promise_.get_future().share();
    work_ = std::move(work);
    done_ = false;
    const auto run = [this]() noexcept {
      std::exception_ptr error;
      try {
        work_();
      } catch (...) {
        error = std::current_exception();
      }
      work_ = nullptr;  // releases what it holds
      if (error)
        promise_.set_exception(error);
      else
        promise_.set_value();
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
    if (const std::shared_future<void> result = std::exchange(result_, {}); result.valid())
      result.get();
  }

  /// The end of the work, for which other threads can wait too: get() throws its exception.  Not valid without work since wait().
  const std::shared_future<void>& result() const noexcept { return result_; }

 private:
  void join() noexcept
  {
    if (thread_.joinable())
      thread_.join();
  }

  std::function<void()> work_;
  std::promise<void> promise_;
  std::shared_future<void> result_;
  std::atomic<bool> done_ = true;
  std::thread thread_;
};

}  // namespace talus
