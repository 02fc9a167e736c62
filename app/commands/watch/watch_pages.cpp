#include "app/commands/watch/watch_pages.hpp"

#include <algorithm>

#include "app/observers/results.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr Real live_megabytes = 8;
constexpr std::size_t live_rows = 1500;
constexpr int rests_per_page = 10;  // a page is made at most so often that it takes a tenth of the time

std::optional<HttpAnswer> text_answer(const char* type, std::string text)
{
  return HttpAnswer{type, std::make_shared<const std::string>(std::move(text))};
}

}  // namespace

std::optional<fs::path> picture_at(const fs::path& folder, const std::string& path)
{
  constexpr std::string_view before = "/pictures/", ending = ".png";
  if (!path.starts_with(before) || !path.ends_with(ending))
    return std::nullopt;
  const std::string name = path.substr(before.size());
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.'; };
  if (name.starts_with('.') || !std::all_of(name.begin(), name.end(), plain))
    return std::nullopt;
  std::error_code gone;
  const fs::path file = folder / "pictures" / name;
  if (!fs::is_regular_file(fs::symlink_status(file, gone)) || fs::is_symlink(fs::symlink_status(folder / "pictures", gone)))
    return std::nullopt;
  return file;
}

std::optional<HttpAnswer> WatchPages::answer(const std::string& path)
{
  const std::scoped_lock lock(readers_);
  asked_at_ = Watch::now();
  if (path == "/stamp")
    return text_answer("text/plain", stamp());
  if (path == "/") {
    if (const std::string now = stamp(); page_ == nullptr || now != stamp_of_page_)
      make_page();
    last_is_given_ = page_is_last_;
    return HttpAnswer{"text/html; charset=utf-8", page_};
  }
  if (const auto picture = picture_at(folder_, path))
    return text_answer("image/png", read_whole(*picture));
  return std::nullopt;
}

bool WatchPages::is_waited_for()
{
  constexpr int questions = 3;  // number of intervals without a request after which the browser counts as closed
  const std::scoped_lock lock(readers_);
  return asked_at_ && !last_is_given_ && Watch::now() - *asked_at_ < std::chrono::duration<Real>(questions * interval_ + 1);
}

std::string WatchPages::stamp()
{
  if (const auto now = Watch::now(); outputs_.empty() || now - stamped_at_ >= rest_) {
    stamped_at_ = now;
    outputs_.clear();
    for (const char* file : {"particles.pvd", "rigid.pvd", "history.csv"})
      outputs_ += state_of(folder_ / file) + ' ';
  }
  stamp_ = state_of(folder_ / "summary.json") + ' ' + outputs_;  // the end of the run is reported at once
  return stamp_;
}

void WatchPages::make_page()
{
  const auto begin = Watch::now();
  const RunFolder run = read_run_folder(folder_);
  PageOptions wishes{{}, {}, live_megabytes, {}, live_rows};
  if (run.state == RunState::at_work)
    wishes.live = interval_;
  std::vector<std::string> notes;
  page_ = std::make_shared<const std::string>(page_of(run, wishes, template_file_, survey_, notes));
  stamp_of_page_ = stamp_;
  page_is_last_ = run.state != RunState::at_work;
  rest_ = rests_per_page * (Watch::now() - begin);
}

}  // namespace talus
