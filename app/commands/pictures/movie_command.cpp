#include "app/commands/pictures/movie_command.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/pictures/settings/launch_render.hpp"
#include "io/system/movie.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> pictures_by(const std::vector<std::string>& words)
{
  std::vector<fs::path> pictures;
  for (const RenderedFile& file : launch_render(words))
    pictures.push_back(file.path);
  return pictures;
}

/// A folder that is removed in the end.
struct Passing {
  fs::path folder;
  ~Passing()
  {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }
};

}  // namespace

bool has_option(const std::vector<std::string>& words, std::string_view option) { return std::ranges::find(words, option) != words.end(); }

void check_movie(const MovieOptions& options, const std::vector<std::string>& words, std::vector<std::string>& problems)
{
  if (!options.movie)
    return;
  if (const std::string problem = movie_problem(*options.movie); !problem.empty())
    problems.push_back("--movie: " + problem);
  if (has_option(words, "--out") && !options.keep_frames)
    problems.emplace_back("--out: of a movie it says where the pictures go that --keep-frames keeps");
}

void make_movie(const MovieOptions& options, std::vector<std::string> words)
{
  require_movie_maker();
  if (options.keep_frames) {
    make_movie(pictures_by(words), options.per_second, *options.movie);
  } else {
    const Passing frames{options.movie->string() + ".frames"};
    words.insert(words.end(), {"--out", frames.folder.string()});
    make_movie(pictures_by(words), options.per_second, *options.movie);
  }
  fmt::print("{}\n", options.movie->string());
}

}  // namespace talus
