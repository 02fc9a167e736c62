#include "app/commands/sweep/sweep_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

#include "io/files/atomic_file.hpp"
#include "io/pictures/settings/launch_render.hpp"
#include "io/terrain/raster_file.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// The ranks from 1; equal values share the mean of their ranks.
std::vector<Real> ranks_of(std::span<const Real> values)
{
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<Real> ranks(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]])
      ++end;
    for (std::size_t k = i; k < end; ++k)
      ranks[order[k]] = 0.5 * static_cast<Real>(i + 1 + end);
    i = end;
  }
  return ranks;
}

/// The part of a file name for a heading: max_kinetic for "max(kinetic) [J]".
std::string file_word(const std::string& heading)
{
  std::string word;
  for (const char c : heading.substr(0, heading.find(" [")))
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-')
      word += c;
    else if (!word.empty() && word.back() != '_')
      word += '_';
  while (!word.empty() && word.back() == '_')
    word.pop_back();
  return word;
}

/// The heading without text that a chart would take for a unit.
std::string as_column(const std::string& heading) { return heading.find(" [") == heading.npos ? heading + " [-]" : heading; }

class Findings {
 public:
  Findings(const SweepPlan& plan, const SweepTable& table, bool pictures, std::vector<std::string>& warnings)
      : plan_(plan), table_(table), pictures_(pictures), warnings_(warnings), headings_(table.number_headings())
  {
    for (std::size_t i = 0; i < plan.cases.size(); ++i)
      if (table.status(i).state == CaseState::done)
        done_.push_back(i);
  }

  std::string operator()()
  {
    if (plan_.study.combine == Combine::latin && done_.size() > 1) {
      correlations();
      for (std::size_t k = 0; k < headings_.size(); ++k)
        exceedance(k);
    }
    if (plan_.study.combine == Combine::tornado)
      for (std::size_t k = 0; k < headings_.size(); ++k)
        tornado(k);
    for (const ExceedSpec& exceed : plan_.study.exceed)
      exceedance_map(exceed);
    return said_;
  }

 private:
  void say(const fs::path& file) { said_ += fmt::format("{}\n", file.string()); }

  void chart(std::vector<std::string> words, const fs::path& picture)
  {
    if (!pictures_)
      return;
    words.insert(words.end(), {"--out", picture.string()});
    try {
      launch_render(words);
      say(picture);
    } catch (const Error& e) {  // the tables exist
      warnings_.push_back(fmt::format("{} is not drawn: {}", picture.string(), e.what()));
      pictures_ = false;
    }
  }

  /// The values of a number in the cases that have it, and of the varied keys.
  struct Sample {
    std::vector<Real> numbers;
    std::vector<std::vector<Real>> keys;  ///< indices [key][case]
  };
  Sample sample_of(std::size_t k) const
  {
    Sample sample;
    sample.keys.resize(plan_.study.vary.size());
    for (const std::size_t i : done_)
      if (const auto number = table_.number(i, k)) {
        sample.numbers.push_back(*number);
        for (std::size_t v = 0; v < sample.keys.size(); ++v)
          sample.keys[v].push_back(std::stod(plan_.cases[i].values[v].text));
      }
    return sample;
  }

  void correlations()
  {
    std::string text = "number";
    std::vector<std::size_t> widths{std::string_view("rank correlation with").size()};
    for (const std::string& heading : headings_)
      widths[0] = std::max(widths[0], heading.size());
    said_ += fmt::format("{:<{}}", "rank correlation with", widths[0]);
    for (const Varied& varied : plan_.study.vary) {
      text += "," + csv_cell(varied.key);
      said_ += "  " + varied.key;
    }
    text += ",cases\n";
    said_ += fmt::format("  cases\n");
    for (std::size_t k = 0; k < headings_.size(); ++k) {
      const Sample sample = sample_of(k);
      text += csv_cell(headings_[k]);
      said_ += fmt::format("{:<{}}", headings_[k], widths[0]);
      for (std::size_t v = 0; v < sample.keys.size(); ++v) {
        const Real r = rank_correlation(sample.keys[v], sample.numbers);
        text += std::isnan(r) ? "," : fmt::format(",{}", r);
        said_ += fmt::format("  {:>{}}", std::isnan(r) ? "-" : fmt::format("{:+.2f}", r), plan_.study.vary[v].key.size());
      }
      text += fmt::format(",{}\n", sample.numbers.size());
      said_ += fmt::format("  {:>5}\n", sample.numbers.size());
    }
    write_whole(plan_.folder / "correlation.csv", text);
    say(plan_.folder / "correlation.csv");
  }

  /// Writes the fraction of cases in which a number is equal or larger, over the number.
  void exceedance(std::size_t k)
  {
    std::vector<Real> values = sample_of(k).numbers;
    if (values.size() < 2)
      return;
    std::sort(values.begin(), values.end());
    std::string text = csv_cell(as_column(headings_[k])) + ",share_of_cases [-]\n";
    for (std::size_t i = 0; i < values.size(); ++i)
      text += fmt::format("{},{}\n", values[i], static_cast<Real>(values.size() - i) / static_cast<Real>(values.size()));
    const fs::path file = plan_.folder / fmt::format("exceedance_{}.csv", file_word(headings_[k]));
    write_whole(file, text);
    say(file);
    if (values.front() < values.back())
      chart({"chart", file.string(), "--title", fmt::format("Share of {} cases that reach a value", values.size()), "--x",
             as_column(headings_[k]), "--y", "share_of_cases [-]", "--marks", "--curve", "cases"},
            fs::path(file).replace_extension(".png"));
  }

  struct Bar {
    std::string key, low_text, high_text;
    Real low, high;
    Real span() const { return std::abs(high - low); }
  };
  /// Writes a number in the low and in the high case of each key, sorted by the effect.
  void tornado(std::size_t k)
  {
    const auto base = table_.number(0, k);
    std::vector<Bar> bars;
    for (std::size_t v = 0; v < plan_.study.vary.size(); ++v) {
      const std::size_t low = 1 + 2 * v, high = low + 1;
      const auto at_low = table_.number(low, k), at_high = table_.number(high, k);
      if (at_low && at_high)
        bars.push_back({plan_.study.vary[v].key, plan_.cases[low].values[v].text, plan_.cases[high].values[v].text, *at_low, *at_high});
    }
    if (!base || bars.empty())
      return;
    std::stable_sort(bars.begin(), bars.end(), [](const Bar& a, const Bar& b) { return a.span() > b.span(); });
    std::string text = fmt::format("key,low value,high value,{},{},{}\n", csv_cell("at low: " + headings_[k]),
                                   csv_cell("at high: " + headings_[k]), csv_cell("all in the middle: " + headings_[k]));
    said_ += fmt::format("{}: {:.6g} with all in the middle\n", headings_[k], *base);
    for (const Bar& bar : bars) {
      text += fmt::format("{},{},{},{},{},{}\n", csv_cell(bar.key), bar.low_text, bar.high_text, bar.low, bar.high, *base);
      said_ += fmt::format("  {}: {:.6g} at {}, {:.6g} at {}\n", bar.key, bar.low, bar.low_text, bar.high, bar.high_text);
    }
    const fs::path file = plan_.folder / fmt::format("tornado_{}.csv", file_word(headings_[k]));
    write_whole(file, text);
    say(file);
    std::vector<std::string> words{
        "tornado", "--x", as_column(headings_[k]), "--title", "One key at a time, low and high", "--base", fmt::format("{}", *base)};
    for (const Bar& bar : bars)
      words.insert(words.end(), {"--bar", fmt::format("{}: {} to {}", bar.key, bar.low_text, bar.high_text), fmt::format("{}", bar.low),
                                 fmt::format("{}", bar.high)});
    chart(std::move(words), fs::path(file).replace_extension(".png"));
  }

  /// The map of a case, as GeoTIFF or as ESRI ASCII grid.
  std::optional<Raster> map_of(std::size_t i, const ExceedSpec& exceed) const
  {
    std::error_code unknown;
    for (const char* ending : {".tif", ".asc"})
      if (const fs::path file = plan_.cases[i].folder / "maps" / (exceed.map + ending); fs::exists(file, unknown))
        return read_raster(file);
    return std::nullopt;
  }

  void exceedance_map(const ExceedSpec& exceed)
  {
    std::optional<Raster> share;
    std::size_t count = 0;
    const auto warn = [&](const std::string& what) {
      warnings_.push_back(fmt::format("{}: {}: {}", to_string(exceed.where), exceed.where.path, what));
    };
    for (const std::size_t i : done_) {
      const std::optional<Raster> map = map_of(i, exceed);
      if (!map)
        return warn(fmt::format("case {} has no maps/{}.tif; outputs.runout of the scene makes maps", plan_.cases[i].number, exceed.map));
      if (!share) {
        share = *map;
        share->unit.clear();
        std::fill(share->values.begin(), share->values.end(), 0);
      }
      const auto same_grid = [&](const Raster& a, const Raster& b) {
        return a.columns == b.columns && a.rows == b.rows && a.west == b.west && a.south == b.south && a.dx == b.dx && a.dy == b.dy &&
               a.crs == b.crs;
      };
      if (!same_grid(*share, *map))
        return warn(fmt::format("the maps of case {} and case {} lie on different grids: give outputs.runout.cell, and all cases one mesh",
                                plan_.cases[done_.front()].number, plan_.cases[i].number));
      for (std::size_t c = 0; c < map->values.size(); ++c)
        share->values[c] += map->values[c] > exceed.above ? 1 : 0;  // NaN compares as false
      ++count;
    }
    if (!share)
      return;
    for (Real& value : share->values)
      value /= static_cast<Real>(count);
    const fs::path file = plan_.folder / fmt::format("exceedance_{}.tif", exceed.map);
    write_raster(file, *share);
    said_ += fmt::format("{}: share of {} cases in which {} exceeds {:.6g}\n", file.string(), count, exceed.map, exceed.above);
  }

  const SweepPlan& plan_;
  const SweepTable& table_;
  bool pictures_;
  std::vector<std::string>& warnings_;
  std::vector<std::string> headings_;
  std::vector<std::size_t> done_;
  std::string said_;
};

}  // namespace

Real rank_correlation(std::span<const Real> a, std::span<const Real> b)
{
  const std::vector<Real> ranks_a = ranks_of(a), ranks_b = ranks_of(b);
  const Real mean = 0.5 * static_cast<Real>(a.size() + 1);
  Real both = 0, squares_a = 0, squares_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Real da = ranks_a[i] - mean, db = ranks_b[i] - mean;
    both += da * db, squares_a += da * da, squares_b += db * db;
  }
  return squares_a > 0 && squares_b > 0 ? both / std::sqrt(squares_a * squares_b) : std::nan("");
}

std::string write_findings(const SweepPlan& plan, const SweepTable& table, bool pictures, std::vector<std::string>& warnings)
{
  return Findings(plan, table, pictures, warnings)();
}

}  // namespace talus
