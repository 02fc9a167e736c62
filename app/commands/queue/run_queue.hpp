#pragma once
// Runs that a command starts some at a time, stops on a signal, and judges at the end.
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "app/commands/queue/planned_run.hpp"

namespace talus {

struct QueueOptions {
  std::filesystem::path scene;
  std::optional<std::string> launcher;
  SideBySide side;
  bool quick = false, quiet = false;
};

/// A run, and its name in messages, such as "case 3".
struct QueuedRun {
  std::string name;
  const PlannedRun* run;
};

/// Words of a command in messages: "cases", "running the sweep again".
struct QueueWords {
  std::string several, again;
};

class RunQueue {
 public:
  /// The state of the run of that number, read from its folder again.
  using LookAgain = std::function<const CaseStatus&(std::size_t)>;

  RunQueue(QueueOptions options, std::vector<QueuedRun> queued, LookAgain look_again);

  /// Runs these until all have ended, or a signal asks for the end.  Throws EnvironmentError.
  void operator()(std::deque<std::size_t> waiting);

  /// The signal that ended the queue, or an empty text.
  const std::string& signal() const noexcept { return signal_; }

  /// Throws RunError if some of the chosen runs failed, Stopped if some were stopped, according to their last known states.
  void conclude(const std::vector<std::size_t>& chosen, const LookAgain& status, const QueueWords& words) const;

 private:
  void say(std::size_t i, const std::string& what) const;
  void start(std::size_t i);
  void look_after();
  void end_of(const ChildRuns::Ended& ended);

  QueueOptions options_;
  std::vector<QueuedRun> queued_;
  LookAgain look_again_;
  ChildRuns runs_;
  std::map<std::size_t, std::string> failures_;
  std::string signal_;
};

}  // namespace talus
