#pragma once
// Answers of `talus watch` to the browser: the page of the run, a stamp that changes with the page, and pictures.
#include <chrono>
#include <memory>
#include <mutex>

#include "app/commands/report/report.hpp"
#include "io/system/http_server.hpp"

namespace talus {

/// Answers `/`, `/stamp` and `/pictures/NAME.png` only; no other file can be requested.  Thread-safe.
class WatchPages {
 public:
  /// `readers`: lock for all reading of results in this process, since VTK's readers are not thread-safe.
  WatchPages(std::filesystem::path folder, std::filesystem::path template_file, Real interval, std::mutex& readers)
      : folder_(std::move(folder)), template_file_(std::move(template_file)), interval_(interval), readers_(readers)
  {}
  std::optional<HttpAnswer> answer(const std::string& path);
  /// Whether there was a recent request, and the final page has not been sent yet.
  bool is_waited_for();

 private:
  using Watch = std::chrono::steady_clock;
  std::string stamp();
  void make_page();

  std::filesystem::path folder_, template_file_;
  Real interval_;
  std::mutex& readers_;
  RunSurvey survey_;
  std::string stamp_, stamp_of_page_;  // stamp of summary and outputs
  std::string outputs_;                // part of the stamp
  bool page_is_last_ = false, last_is_given_ = false;
  std::optional<Watch::time_point> asked_at_;
  std::shared_ptr<const std::string> page_;
  Watch::time_point stamped_at_;
  Watch::duration rest_{};  ///< time until the results are read again
};

/// The picture that a path such as "/pictures/displacement_0003.png" names, if it is an ordinary file of the run's pictures.
std::optional<std::filesystem::path> picture_at(const std::filesystem::path& folder, const std::string& path);

}  // namespace talus
