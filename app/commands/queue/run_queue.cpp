#include "app/commands/queue/run_queue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.hpp"
#include "io/system/signals.hpp"

namespace talus {

namespace {

/// The reason why existing results do not count.
std::string remark(const CaseStatus& status)
{
  const bool without = !status.goes_on_from && (status.state == CaseState::stopped || status.state == CaseState::not_ended);
  if (without)
    return "; what is there has no checkpoint to go on from";
  return status.state == CaseState::to_run && !status.why.empty() ? "; " + status.why : "";
}

std::string told_changes(const PlannedRun& run) { return run.changes.empty() ? "the scene as it is" : in_words(run); }

}  // namespace

RunQueue::RunQueue(QueueOptions options, std::vector<QueuedRun> queued, LookAgain look_again)
    : options_(std::move(options)),
      queued_(std::move(queued)),
      look_again_(std::move(look_again)),
      runs_(options_.launcher, options_.side.threads, options_.quick)
{}

void RunQueue::operator()(std::deque<std::size_t> waiting)
{
  const StopRequests requests;
  bool told_to_end = false;
  while (runs_.count() > 0 || (!waiting.empty() && StopRequests::received().empty())) {
    while (!waiting.empty() && runs_.count() < options_.side.jobs && StopRequests::received().empty()) {
      start(waiting.front());
      waiting.pop_front();
    }
    if (!StopRequests::received().empty() && !std::exchange(told_to_end, true))
      runs_.ask_to_end();
    look_after();
  }
  signal_ = StopRequests::received();
}

void RunQueue::say(std::size_t i, const std::string& what) const
{
  if (options_.quiet)
    return;
  fmt::print("{}: {}\n", queued_[i].name, what);
  std::fflush(stdout);
}

void RunQueue::start(std::size_t i)
{
  const PlannedRun& run = *queued_[i].run;
  const CaseStatus status = status_of(run, options_.quick);  // another process may have run it in the meantime
  if (status.state == CaseState::done)
    return say(i, "is done");
  if (status.state == CaseState::not_ended && is_at_work(run))
    return say(i, "another process is at work on it");
  runs_.start(i, options_.scene, run, status);
  say(i, fmt::format("{} ({}{})", status.goes_on_from ? fmt::format("goes on after t = {:.6g} s", *status.goes_on_from) : "begins",
                     told_changes(run), remark(status)));
}

/// Waits a little; handles runs that have ended.
void RunQueue::look_after()
{
  for (const ChildRuns::Ended& ended : runs_.look())
    end_of(ended);
}

void RunQueue::end_of(const ChildRuns::Ended& ended)
{
  const std::size_t i = ended.number;
  const CaseStatus& status = look_again_(i);
  if (ended.code == 0 && status.state == CaseState::done)
    return say(i, fmt::format("done after {:.1f} s", ended.seconds));
  const bool before_its_first_step = runs_.ended_before_its_first_step(ended.code);
  if (ended.code == run_was_stopped || before_its_first_step)
    return say(
        i, before_its_first_step ? "ended before its first step" : fmt::format("stopped at t = {:.6g} s", status.goes_on_from.value_or(0)));
  failures_[i] = runs_.why(*queued_[i].run, ended.code, status);
  say(i, "FAILED, see below");
}

void RunQueue::conclude(const std::vector<std::size_t>& chosen, const LookAgain& status, const QueueWords& words) const
{
  const auto count = [&](CaseState state) {
    return std::ranges::count_if(chosen, [&](std::size_t i) { return status(i).state == state; });
  };
  const auto done = count(CaseState::done), stopped = count(CaseState::stopped);
  if (!signal_.empty() && done < std::ssize(chosen))
    throw Stopped(fmt::format("stopped by {}: of {} {} {} done, {} stopped with a checkpoint; go on by {}", signal_, chosen.size(),
                              words.several, done, stopped, words.again));
  if (!failures_.empty()) {
    std::string text = fmt::format("{} of {} {} failed; {} repeats them", failures_.size(), chosen.size(), words.several, words.again);
    for (const auto& [i, message] : failures_)
      text += fmt::format("\n  {} ({}): {}", queued_[i].name, told_changes(*queued_[i].run), message);
    throw RunError(text);
  }
  if (stopped > 0)
    throw Stopped(fmt::format("of {} {} {} done, {} stopped with a checkpoint; go on by {}", chosen.size(), words.several, done, stopped,
                              words.again));
}

}  // namespace talus
