#pragma once
// Run-out: moved particles on cells over the plan during the run; runout.csv, maps and sections.
#include <filesystem>

#include "app/observers/runout_distance.hpp"
#include "app/observers/runout_files.hpp"
#include "app/observers/schedule.hpp"
#include "io/output/run_summary.hpp"

namespace talus {

/// Observes the moved particles.  Those of all ranks are collected at each sample and summed in the order of their ids, so that results are
/// bitwise identical for any number of ranks.  The root has maps, numbers and files.
template <int D>
class Runout {
 public:
  /// `spec` must outlive it; without a spec nothing is done.
  Runout(std::filesystem::path folder, const std::optional<RunoutSpec>& spec);

  /// Begins with the first stage that is neither geostatic nor static.  This and the functions below are collective.
  void begin(const RunView<D>& view);
  bool has_begun() const noexcept { return begun_; }
  /// Takes a sample if one is due or it is the last of a stage, and writes a frame if requested.  Returns the files of frames.
  std::vector<std::string> see(const RunView<D>& view, bool last);
  /// Writes the maps and sections at the last sample; returns their files, relative to the folder.
  std::vector<std::string> write_maps(const RunView<D>& view);

  /// Continues the files of a run whose state has been read.
  void go_on(const RunView<D>& view);
  /// On the root: removes frames that are later than the state; returns whether runout.csv is complete.
  bool drop_later() const;
  /// runout.csv, on the root; nullptr before begin().
  const HistoryFile* table() const noexcept { return file_ ? &*file_ : nullptr; }
  /// Numbers for the summary; empty before the first sample.
  std::vector<NamedValue> numbers() const;

  static constexpr auto fields()
  {
    return std::tuple{saved("begun", &Runout::begun_),
                      saved("start", &Runout::start_),
                      saved("times", &Runout::times_),
                      saved("frame_times", &Runout::frame_times_),
                      saved("frames", &Runout::frames_),
                      saved("time", &Runout::time_),
                      saved("now", &Runout::now_),
                      saved("fastest", &Runout::fastest_),
                      saved("thickest", &Runout::thickest_),
                      saved("still_since", &Runout::still_since_),
                      saved("ground", &Runout::ground_),
                      saved("base", &Runout::base_),
                      saved("surface", &Runout::surface_),
                      saved("surface_max", &Runout::surface_max_),
                      saved("thickness", &Runout::thickness_),
                      saved("thickness_max", &Runout::thickness_max_),
                      saved("speed_max", &Runout::speed_max_),
                      saved("intensity_max", &Runout::intensity_max_),
                      saved("arrival", &Runout::arrival_),
                      saved("source", &Runout::source_),
                      saved("erosion", &Runout::erosion_)};
  }

 private:
  struct CellValue;
  void lay_out(const RunView<D>& view);
  void look(const RunView<D>& view, bool with_frame);
  template <class Pick>
  std::vector<Real> joined(Communicator& ranks, const std::vector<Real>& here, Pick&& pick) const;
  std::vector<Real> tops(const RunView<D>& view) const;
  void count_on_cells(const std::vector<MovedParticle<D>>& moved, Real since_start);
  bool at_rest() const;
  bool erodes() const { return !spec_->eroded.empty(); }
  std::vector<CsvColumn> columns_of_file() const;
  std::vector<NamedMap> maps() const;
  std::filesystem::path frame_file(int n) const;

  std::filesystem::path folder_;
  const std::optional<RunoutSpec>& spec_;
  RunoutPlan plan_;
  Real moved_ = 0, threshold_ = 0;  // from the spec, or the defaults [m]
  std::optional<HistoryFile> file_;

  bool begun_ = false;
  Real start_ = 0;  // time of the beginning [s]
  Schedule times_, frame_times_;
  int frames_ = 0;
  Real time_ = -1;  // time of the last sample [s]
  RunoutNumbers now_;
  Real fastest_ = 0, thickest_ = 0;  // largest values so far [m/s], [m]
  Real still_since_ = 0;             // time since which the mass has been at rest, infinite while it moves [s]
  std::vector<Real> ground_, base_, surface_, surface_max_, thickness_, thickness_max_, speed_max_, intensity_max_, arrival_, source_,
      erosion_;
};

extern template class Runout<2>;
extern template class Runout<3>;

}  // namespace talus
