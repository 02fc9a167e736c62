// talus watch
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <thread>

#include "app/commands/watch/watch_command.hpp"
#include "app/commands/watch/watch_look.hpp"
#include "app/commands/watch/watch_pages.hpp"
#include "core/error.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr int run_failed = 1, run_stopped = 4;  // exit codes of `talus run`

struct Terminal {
  bool is_there = ::isatty(STDOUT_FILENO) == 1;
  int columns = 80;

  Terminal()
  {
    winsize size{};
    if (is_there && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
      columns = size.ws_col;
  }
};

/// The first `most` characters of a line; a wrapped line would spoil the count of lines to overwrite.
std::string cut(const std::string& line, int most)
{
  std::size_t end = 0;
  int letters = 0;
  for (; end < line.size(); ++end)
    if ((static_cast<unsigned char>(line[end]) & 0xC0U) != 0x80 && ++letters > most)
      break;
  return line.substr(0, end);
}

/// Follows one run.
class Follower {
 public:
  explicit Follower(const WatchOptions& options) : options_(options), run_(read_run_folder(options.folder)), summary_state_(summary_now())
  {}

  int operator()()
  {
    look();
    if (look_.state == RunState::at_work && !options_.once) {
      try {
        serve();
      } catch (const EnvironmentError& error) {
        if (options_.page || pages_)  // the page or the port was requested
          throw;
        fmt::print(stderr, "note: no page for the browser: {}\n", error.what());
      }
      follow();
      give_last_page();
    }
    show_all();
    switch (look_.state) {
      case RunState::failed:
      case RunState::killed: return run_failed;
      case RunState::stopped: return run_stopped;
      default: return 0;
    }
  }

 private:
  std::string summary_now() const { return state_of(options_.folder / "summary.json"); }

  void serve()
  {
    if (!options_.serve)
      return;
    const fs::path page = page_template(options_.page);
    if (!fs::exists(page))
      throw EnvironmentError(fmt::format("--page {} is not there", page.string()));
    pages_ = std::make_unique<WatchPages>(options_.folder, page, options_.interval, readers_);
    server_ = std::make_unique<HttpServer>(options_.port, [this](const std::string& path) { return pages_->answer(path); });
    fmt::print("page: http://127.0.0.1:{}/\n", server_->port());
    std::fflush(stdout);
  }

  void follow()
  {
    std::string last;
    while (look_.state == RunState::at_work) {
      if (terminal_.is_there) {
        show_all();
      } else if (const std::string line = in_one_line(run_, look_); line != last) {
        fmt::print("{}\n", line);
        last = line;
      }
      std::fflush(stdout);
      std::this_thread::sleep_for(std::chrono::duration<Real>(options_.interval));
      look();
    }
  }

  /// Waits until a browser that shows the page has received the final state.
  void give_last_page()
  {
    constexpr std::chrono::milliseconds between(50);
    constexpr std::chrono::seconds most(20);
    const auto until = std::chrono::steady_clock::now() + most;
    while (pages_ && pages_->is_waited_for() && std::chrono::steady_clock::now() < until)
      std::this_thread::sleep_for(between);
  }

  /// Reads the present state.  The summary is missing for a moment when a run is restarted in the folder.
  void look()
  {
    const std::scoped_lock lock(readers_);
    try {
      if (const std::string now = summary_now(); now != summary_state_) {
        run_ = read_run_folder(options_.folder);
        summary_state_ = now;
      }
      look_ = look_at(run_, look_);
    } catch (const Error&) {
      if (!fs::exists(options_.folder))
        throw Error(fmt::format("{} has gone while it was watched", options_.folder.string()));
    }
  }

  /// Prints the state; on a terminal in place of the previous one.
  void show_all()
  {
    const Terminal now;
    std::string text;
    if (now.is_there && lines_shown_ > 0)
      text += fmt::format("\033[{}A\033[J", lines_shown_);
    lines_shown_ = 0;
    const auto put = [&](const std::string& line) {
      text += line + '\n';
      ++lines_shown_;
    };
    for (const std::string& line : described(run_, look_))
      put(now.is_there ? cut(line, now.columns - 1) : line);
    fmt::print("{}", text);
    std::fflush(stdout);
  }

  const WatchOptions& options_;
  RunFolder run_;
  std::string summary_state_;
  RunLook look_;
  Terminal terminal_;
  int lines_shown_ = 0;
  std::mutex readers_;
  std::unique_ptr<WatchPages> pages_;
  std::unique_ptr<HttpServer> server_;
};

}  // namespace

int watch_run(const WatchOptions& options) { return Follower(options)(); }

}  // namespace talus
