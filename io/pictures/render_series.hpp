#pragma once
// The particle files of a run, some of which may be damaged.
#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <set>
#include <vector>

#include "core/error.hpp"
#include "io/pictures/render_data.hpp"

namespace talus::render {

/// Files that cannot be read are skipped, and named once on standard error.
class FrameSeries {
 public:
  explicit FrameSeries(std::vector<ResultFile> files) : files_(std::move(files)) {}

  std::size_t size() const noexcept { return files_.size(); }
  Real time(std::size_t frame) const { return files_[frame].time; }

  /// The result of read(path) for one frame; nothing if it throws EnvironmentError.
  template <class Read>
  auto read(std::size_t frame, Read&& read) -> std::optional<decltype(read(std::filesystem::path()))>
  {
    try {
      return read(files_[frame].path);
    } catch (const EnvironmentError& damaged) {
      if (left_out_.insert(frame).second)
        fmt::print(stderr, "warning: the frame at t = {:.6g} s is left out: {}\n", files_[frame].time, damaged.what());
      return std::nullopt;
    }
  }
  /// The result of read(path) for the first frame that can be read.  Throws EnvironmentError if there is none.
  template <class Read>
  auto first(Read&& read_one)
  {
    for (std::size_t frame = 0; frame < size(); ++frame)
      if (auto result = read(frame, read_one))
        return *std::move(result);
    throw_all_damaged();
  }
  /// The result for the last frame that can be read.
  template <class Read>
  auto last(Read&& read_one)
  {
    for (std::size_t frame = size(); frame-- > 0;)
      if (auto result = read(frame, read_one))
        return *std::move(result);
    throw_all_damaged();
  }

 private:
  [[noreturn]] void throw_all_damaged() const
  {
    throw EnvironmentError(
        fmt::format("none of the {} particle files of {} can be read", size(), files_.front().path.parent_path().string()));
  }

  std::vector<ResultFile> files_;
  std::set<std::size_t> left_out_;
};

}  // namespace talus::render
