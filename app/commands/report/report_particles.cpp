#include "app/commands/report/report_particles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/parallel/threads.hpp"
#include "mesh/geometry/spacing.hpp"
#include "solver/particles/resample.hpp"

namespace talus {

namespace {

/// The shown particles of a frame.
struct ShownFrame {
  std::vector<std::int64_t> ids;
  std::vector<std::uint8_t> body;         // empty if there is one body
  std::vector<Real> places;               // 3 numbers per particle
  std::vector<Real> volume;               // m^3, m^2 in 2-D; empty if not in the file
  std::vector<std::vector<Real>> fields;  // empty if not in the file
};

template <class T>
std::vector<T> chosen_rows(const std::vector<T>& all, const std::vector<std::size_t>& rows, std::size_t width)
{
  std::vector<T> some;
  some.reserve(rows.size() * width);
  for (const std::size_t row : rows)
    some.insert(some.end(), all.begin() + static_cast<std::ptrdiff_t>(row * width),
                all.begin() + static_cast<std::ptrdiff_t>((row + 1) * width));
  return some;
}

ShownFrame read_shown(const RunSurvey& survey, std::size_t frame, const PagePlan& plan, std::size_t bodies)
{
  const StoredParticles particles = read_particles(survey.frames[frame].file);
  std::vector<std::size_t> rows;
  for (std::size_t p = 0; p < particles.ids.size(); ++p)
    if (is_sampled(particles.ids[p], plan.share))
      rows.push_back(p);
  ShownFrame shown{chosen_rows(particles.ids, rows, 1), {}, chosen_rows(particles.fields.front().values, rows, 3), {}, {}};
  if (const StoredField* volume = stored_field(particles, "volume"); volume != nullptr && volume->components == 1)
    shown.volume = chosen_rows(volume->values, rows, 1);
  if (const StoredField* body = bodies > 1 ? stored_field(particles, "body") : nullptr)
    for (const std::size_t row : rows)
      shown.body.push_back(static_cast<std::uint8_t>(std::clamp<Real>(body->values[row], 0, 255)));
  for (std::size_t f = 0; f < plan.fields; ++f) {
    const StoredField* field = stored_field(particles, survey.fields[f].name);
    shown.fields.push_back(field == nullptr ? std::vector<Real>() : chosen_rows(viewed_values(*field, survey.fields[f]), rows, 1));
  }
  return shown;
}

std::vector<Real> coordinate(const std::vector<Real>& places, std::size_t axis)
{
  std::vector<Real> values(places.size() / 3);
  for (std::size_t p = 0; p < values.size(); ++p)
    values[p] = places[3 * p + axis];
  return values;
}

/// By how many hundredths of the radius each disc is larger, so that neighbours leave no holes; empty if none is.
std::vector<std::uint8_t> growth_of(std::span<const Real> places, Real radius, std::span<const Real> spread)
{
  const std::vector<Real> radii = closing_radii(places, radius, spread);
  if (std::all_of(radii.begin(), radii.end(), [&](Real one) { return one <= radius; }))
    return {};
  std::vector<std::uint8_t> growth;
  for (const Real one : radii)
    growth.push_back(static_cast<std::uint8_t>(std::clamp<Real>(std::ceil(100 * (one / radius - 1)), 0, 255)));
  return growth;
}

/// Adds frames to a page in sequence.  Data that do not change are stored once.
class FrameWriter {
 public:
  FrameWriter(const RunSurvey& survey, const ParticleWishes& wishes, const PagePlan& plan, Page& page)
      : survey_(survey),
        plan_(plan),
        dimension_(static_cast<std::size_t>(wishes.dimension)),
        bodies_(wishes.bodies.size()),
        rigid_(wishes.rigid),
        page_(page)
  {
    for (std::size_t f = 0; f < plan.fields; ++f)
      ranges_.push_back(range_over_frames(survey, f));
  }

  PageFrame add(std::size_t number)
  {
    const ShownFrame shown = read_shown(survey_, number, plan_, bodies_);
    const FrameSurvey& known = survey_.frames[number];
    const MassSurvey& all = known.masses.front();
    std::vector<PageBlock> blocks(dimension_ + plan_.fields);
    parallel_for_uneven(static_cast<Index>(blocks.size()), [&](Index i) {
      const auto k = static_cast<std::size_t>(i);
      const bool of_place = k < dimension_;
      const std::vector<Real> values = of_place ? coordinate(shown.places, k) : shown.fields[k - dimension_];
      const auto axis = static_cast<Index>(std::min<std::size_t>(k, 2));
      const ValueRange range = of_place ? ValueRange{all.low[axis], all.high[axis]} : ranges_[k - dimension_];
      blocks[k] = packed(quantised(values, range.low, range.high));
    });
    if (radius_ == 0 && !shown.ids.empty()) {
      radius_ = drawn_radius(shown.places, static_cast<int>(dimension_));
      spread_ = Spread(shown.ids, shown.volume);
    }
    PageFrame frame{known.time,
                    static_cast<std::int64_t>(shown.ids.size()),
                    {all.low, all.high, {}},
                    add_ids(shown.ids),
                    add_body(shown.body),
                    add_growth(shown),
                    {},
                    {}};
    for (std::size_t d = 0; d < dimension_; ++d)
      frame.x.axes.push_back(page_.add(std::move(blocks[d])));
    for (std::size_t f = 0; f < plan_.fields; ++f)
      frame.fields.push_back(shown.fields[f].empty() && !shown.ids.empty() ? std::nullopt
                                                                           : std::optional(page_.add(std::move(blocks[dimension_ + f]))));
    frame.rigid = rigid_.add(known.time, page_);
    return frame;
  }
  Real radius() const noexcept { return radius_; }

 private:
  BlockId add_ids(const std::vector<std::int64_t>& ids)
  {
    if (!last_ids_ || *last_ids_ != ids) {
      // Numbers from 2^40 on, of particles that were split, are those from 2^31 on here: see viewer.js.
      std::vector<std::uint32_t> numbers;
      for (const std::int64_t id : ids)
        numbers.push_back(id < first_resampled_id ? static_cast<std::uint32_t>(id)
                                                  : std::uint32_t{1} << 31 | static_cast<std::uint32_t>(id - first_resampled_id));
      id_block_ = page_.add(packed(numbers));
      last_ids_ = ids;
    }
    return id_block_;
  }
  std::optional<BlockId> add_body(const std::vector<std::uint8_t>& body)
  {
    if (body.empty())
      return std::nullopt;
    if (body != last_body_) {
      body_block_ = page_.add(packed(body));
      last_body_ = body;
    }
    return body_block_;
  }
  std::optional<BlockId> add_growth(const ShownFrame& shown)
  {
    const auto growth = dimension_ == 2 ? growth_of(shown.places, radius_, spread_.of(shown.ids)) : std::vector<std::uint8_t>();
    return growth.empty() ? std::nullopt : std::optional(page_.add(packed(growth)));
  }

  const RunSurvey& survey_;
  const PagePlan& plan_;
  std::size_t dimension_, bodies_;
  const RigidFrames& rigid_;
  Page& page_;
  std::vector<ValueRange> ranges_;
  std::optional<std::vector<std::int64_t>> last_ids_;
  std::vector<std::uint8_t> last_body_;
  BlockId id_block_ = 0, body_block_ = 0;
  Real radius_ = 0;
  Spread spread_;
};

/// An estimate before any measurement, from irregular meshes in 3-D.
ParticleCost guess(const RunSurvey& survey, int dimension)
{
  constexpr Real place = 2, field = 1;  // bytes per axis and per field
  return {1, place * dimension, std::vector<Real>(survey.fields.size(), field), 0};
}

/// Measures the cost with the first, middle and last frame of a plan.
ParticleCost measure(const RunSurvey& survey, const ParticleWishes& wishes, const PagePlan& plan)
{
  PagePlan all_fields = plan;
  all_fields.fields = survey.fields.size();
  constexpr Real of_block = 200, of_frame = 300;  // bytes of descriptions
  const auto blocks =
      static_cast<Real>(survey.fields.size()) + wishes.dimension + (wishes.dimension == 2 ? 1 : 0) + (wishes.rigid.any() ? 1 : 0);
  ParticleCost cost{0, 0, std::vector<Real>(survey.fields.size()), of_frame + of_block * blocks};
  const auto frames = evenly_spread(std::min<std::size_t>(3, plan.frames.size()), plan.frames.size());
  for (const std::size_t f : frames) {
    Page scratch;
    const PageFrame frame = FrameWriter(survey, wishes, all_fields, scratch).add(plan.frames[f]);
    const Real one = 1 / static_cast<Real>(std::max<std::int64_t>(frame.count, 1));
    const auto bytes = [&](BlockId b) { return one * static_cast<Real>(scratch.blocks[b].base64.size()); };
    const Real share = 1 / static_cast<Real>(frames.size());
    cost.once = std::max(cost.once, bytes(frame.ids) + (frame.body ? bytes(*frame.body) : 0));
    for (const BlockId axis : frame.x.axes)
      cost.place += share * bytes(axis);
    cost.place += frame.growth ? share * bytes(*frame.growth) : 0;
    cost.frame += frame.rigid ? share * static_cast<Real>(scratch.blocks[*frame.rigid].base64.size()) : 0;
    for (std::size_t k = 0; k < frame.fields.size(); ++k)
      cost.fields[k] += frame.fields[k] ? share * bytes(*frame.fields[k]) : 0;
  }
  return cost;
}

std::int64_t most_particles(const RunSurvey& survey)
{
  std::int64_t most = 0;
  for (const FrameSurvey& frame : survey.frames)
    most = std::max(most, frame.count);
  return most;
}

std::vector<std::string> words_of_fields(std::span<const ViewedField> fields)
{
  std::vector<std::string> names;
  for (const ViewedField& field : fields)
    names.push_back(words_of(field));
  return names;
}

/// Descriptions of what a plan leaves out.
std::vector<std::string> notes_of(const RunSurvey& survey, const PagePlan& plan, std::int64_t total, std::int64_t shown)
{
  std::vector<std::string> notes;
  if (plan.frames.size() < survey.frames.size())
    notes.push_back(
        fmt::format("frames: {} of {} are shown, evenly spread; numbers come from all", plan.frames.size(), survey.frames.size()));
  if (const auto left = std::span(survey.fields).subspan(plan.fields); !left.empty())
    notes.push_back(fmt::format("fields: without {}; --fields chooses others", fmt::join(words_of_fields(left), ", ")));
  if (shown < total)
    notes.push_back(
        fmt::format("particles: {} of {} are shown, a fair sample, the same ones in each frame; numbers come from all", shown, total));
  return notes;
}

/// Plans the contents of a page within a budget, for the requested frames.
class Planner {
 public:
  Planner(const RunSurvey& survey, const ParticleWishes& wishes)
      : total_(most_particles(survey)),
        offered_(evenly_spread(std::clamp<std::size_t>(wishes.frames.value_or(survey.frames.size()), 1, survey.frames.size()),
                               survey.frames.size())),
        kept_{wishes.frames.has_value(), wishes.fields_asked_for},
        cost_(guess(survey, wishes.dimension))
  {
    cost_ = measure(survey, wishes, within(wishes.budget));
  }
  PagePlan within(Real budget) const
  {
    PagePlan plan = plan_page(total_, offered_.size(), cost_, budget, kept_);
    for (std::size_t& frame : plan.frames)
      frame = offered_[frame];
    return plan;
  }

 private:
  std::int64_t total_;
  std::vector<std::size_t> offered_;
  KeptAnyway kept_;
  ParticleCost cost_;
};

}  // namespace

bool is_sampled(std::int64_t id, Real share) noexcept
{
  if (share >= 1)
    return true;
  auto bits = static_cast<std::uint64_t>(id) + 0x9e3779b97f4a7c15U;  // splitmix64, so that neighbouring numbers give independent results
  bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
  bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
  bits ^= bits >> 31U;
  return static_cast<Real>(bits >> 11U) * 0x1p-53 < share;
}

void add_particles(const RunSurvey& survey, const ParticleWishes& wishes, Page& page)
{
  if (survey.frames.empty())
    return;
  const Planner planner(survey, wishes);
  Real budget = wishes.budget;
  PagePlan plan = planner.within(budget);
  const std::size_t before = page.blocks.size(), bytes_before = page.block_bytes() + to_json(page).size();
  PageParticles particles{most_particles(survey), 0, 1, wishes.bodies, {}, {}, wishes.range};
  for (int attempt = 1;; ++attempt) {
    FrameWriter writer(survey, wishes, plan, page);
    for (const std::size_t frame : plan.frames)
      particles.frames.push_back(writer.add(frame));
    particles.radius = writer.radius() > 0 ? writer.radius() : 1;
    page.particles = particles;
    constexpr Real words = 800;  // bytes for names of fields and notes
    const Real bytes = static_cast<Real>(page.block_bytes() + to_json(page).size() - bytes_before) + words;
    if (bytes <= wishes.budget)
      break;
    constexpr Real a_little_less = 0.99;  // the measurement on three frames was too low
    constexpr int most_attempts = 6;
    if (attempt == most_attempts)
      throw Error(fmt::format("--size: too small: {} times of {} fields do not fit", plan.frames.size(), plan.fields));
    budget *= a_little_less * wishes.budget / bytes;
    plan = planner.within(budget);
    page.blocks.resize(before);
    particles.frames.clear();
  }
  for (const PageFrame& frame : particles.frames)
    particles.shown = std::max(particles.shown, frame.count);
  for (std::size_t f = 0; f < plan.fields; ++f) {
    const ValueRange range = range_over_frames(survey, f);
    particles.fields.push_back({words_of(survey.fields[f]), survey.labels[f], survey.units[f], range.low, range.high});
  }
  for (const std::string& note : notes_of(survey, plan, particles.total, particles.shown))
    page.notes.push_back(note);
  page.particles = std::move(particles);
}

}  // namespace talus
