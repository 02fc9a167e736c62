#pragma once
// Writes files for ParaView while the next steps run.
#include <filesystem>
#include <string>
#include <vector>

#include "app/observers/frame.hpp"
#include "core/parallel/background_task.hpp"
#include "core/parallel/communicator.hpp"

namespace talus {

/// A run of one rank writes one frame at a time on a thread of its own: compression, disk and the lists of files do not delay its steps.
/// Several ranks write a frame together before the next step, because only their main threads may send messages.  Either way a file is
/// written atomically and then named in its list, and the bytes are the same.
class FrameOutput {
 public:
  FrameOutput(const std::filesystem::path& folder, const std::string& made_by);

  /// Writes a frame, or begins to, after wait().
  void write(Communicator& ranks, Frame frame);
  /// Whether a frame has been begun whose end wait() has not reported.
  bool is_pending() const noexcept { return pending_; }
  bool is_done() const noexcept { return task_.is_done(); }
  /// Returns when the frame is on the disk.  Throws EnvironmentError with the name of the file if it could not be written; files before it
  /// have been.
  void wait();
  /// The end of the frame that is being written, for which other threads can wait; not valid if there is none.
  const std::shared_future<void>& result() const noexcept { return task_.result(); }
  /// The files on the disk of the last frame, after wait() or an exception of it.
  const std::vector<std::string>& written() const noexcept { return written_; }

  /// Drops what the lists name after a time [s].
  void resume(Real time);
  PvdSeries& particle_series() noexcept { return particle_series_; }
  PvdSeries& mesh_series() noexcept { return mesh_series_; }

 private:
  void write_now(Communicator& ranks, const Frame& frame);

  std::string made_by_;
  PvdSeries particle_series_, mesh_series_, rigid_series_;
  std::vector<std::string> written_;
  bool pending_ = false;
  BackgroundTask task_;  // last: its destructor waits while the others exist
};

}  // namespace talus
