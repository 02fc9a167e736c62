// Runs ffmpeg as a program; its libraries would be three more dependencies for one command.
#include "io/system/movie.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/system/child_process.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr auto maker = "ffmpeg";

/// Links 000000.png, 000001.png ... to the pictures, because ffmpeg needs numbers without gaps.
class Series {
 public:
  Series(const std::vector<fs::path>& pictures, fs::path folder) : folder_(std::move(folder))
  {
    std::error_code failed;
    fs::remove_all(folder_, failed);
    fs::create_directories(folder_, failed);
    for (std::size_t i = 0; i < pictures.size() && !failed; ++i)
      fs::create_symlink(fs::absolute(pictures[i]), folder_ / fmt::format("{:06}.png", i), failed);
    if (failed)
      throw EnvironmentError(fmt::format("cannot write {}: {}", folder_.string(), failed.message()));
  }
  ~Series()
  {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Series(const Series&) = delete;
  Series& operator=(const Series&) = delete;

  /// The pattern of names; a percent sign in the path is doubled.
  std::string pattern() const
  {
    std::string text;
    for (const char c : folder_.string())
      text += c == '%' ? std::string("%%") : std::string(1, c);
    return text + "/%06d.png";
  }

 private:
  fs::path folder_;
};

/// The options for the format.
std::vector<std::string> encoding(const fs::path& file)
{
  if (file.extension() == ".gif")  // few colours, lightly dithered: smooth colour bars, and constant areas without noise
    return {"-filter_complex",
            "split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=bayer:bayer_scale=4:diff_mode=rectangle",
            "-loop",
            "0",
            "-f",
            "gif"};
  return {"-vf",       "pad=ceil(iw/2)*2:ceil(ih/2)*2:0:0:white",
          "-c:v",      "libx264",
          "-preset",   "medium",
          "-crf",      "18",
          "-pix_fmt",  "yuv420p",
          "-movflags", "+faststart",
          "-f",        "mp4"};
}

}  // namespace

std::string movie_problem(const fs::path& file)
{
  return file.extension() == ".mp4" || file.extension() == ".gif" ? "" : fmt::format("{} should end in .mp4 or .gif", file.string());
}

void require_movie_maker()
{
  if (!on_path(maker))
    throw EnvironmentError(
        "movies are made by the program ffmpeg, which is missing: install the package ffmpeg (Debian: apt-get install "
        "ffmpeg); --frames all without --movie leaves the pictures as numbered files");
}

void make_movie(const std::vector<fs::path>& pictures, Real per_second, const fs::path& file)
{
  require_movie_maker();
  write_whole(file, [&](const fs::path& temporary) {
    const Series series(pictures, temporary.string() + ".series");
    std::vector<std::string> words{maker, "-nostdin",      "-v", "error", "-y", "-framerate", fmt::format("{}", per_second),
                                   "-i",  series.pattern()};
    const auto format = encoding(file);
    words.insert(words.end(), format.begin(), format.end());
    words.push_back(fs::absolute(temporary).string());  // an absolute path, so that a name that begins with a minus sign is not an option
    if (const Ending ending = run_to_its_end(words); ending.code != 0)
      throw EnvironmentError(fmt::format("cannot write {}: ffmpeg failed (exit code {}): {}", file.string(), ending.code, ending.output));
  });
}

}  // namespace talus
