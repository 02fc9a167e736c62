#pragma once
// Run-out: what has moved, seen on cells over the plan while the run goes; runout.csv, maps and sections.
#include <filesystem>

#include "app/observers/schedule.hpp"
#include "io/files/runout_maps.hpp"
#include "io/output/csv.hpp"
#include "io/output/run_summary.hpp"
#include "io/scene/scene_runout.hpp"
#include "mesh/geometry/map_frame.hpp"
#include "mesh/geometry/plan_grid.hpp"
#include "mesh/geometry/raster.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// Which way is up, and which axes make up the plan, so that east, north and up are right-handed.
struct PlanAxes {
  Vec3 up;                    ///< against gravity, of unit length
  Index vertical;             ///< the axis nearest to it
  Real sign;                  ///< of `up` along that axis
  std::array<Index, 2> plan;  ///< 2-D: only the first
};
template <int D>
PlanAxes plan_axes(const Vec<D>& gravity);

/// Of all that has moved, at a look.  NaN where nothing has.
struct RunoutNumbers {
  Real volume = 0;      ///< of what has moved [m^D]
  Real area = 0;        ///< where it is thicker than the threshold [m^(D-1)]
  Real mean = 0;        ///< its thickness there [m]
  Real thickest = 0;    ///< [m]
  Real fastest = 0;     ///< of a particle [m/s]
  Real mean_speed = 0;  ///< of the mass that has moved [m/s]
  Real bulk = 0;        ///< speed that `mass_share` of the mass that has moved does not exceed [m/s]
  Real kinetic = 0;     ///< [J]
  Vec3 front = Vec3::Zero();
  Real height = 0, length = 0;                ///< from the crown to the front [m]
  Vec3 centre = Vec3::Zero();                 ///< of mass
  Real centre_height = 0, centre_length = 0;  ///< from where it was at the start [m]
  Real entrained = 0;                         ///< volume of eroded bodies in it [m^D]
  static constexpr auto fields()
  {
    using N = RunoutNumbers;
    return std::tuple{saved("volume", &N::volume),
                      saved("area", &N::area),
                      saved("mean", &N::mean),
                      saved("thickest", &N::thickest),
                      saved("fastest", &N::fastest),
                      saved("mean_speed", &N::mean_speed),
                      saved("bulk", &N::bulk),
                      saved("kinetic", &N::kinetic),
                      saved("front", &N::front),
                      saved("height", &N::height),
                      saved("length", &N::length),
                      saved("centre", &N::centre),
                      saved("centre_height", &N::centre_height),
                      saved("centre_length", &N::centre_length),
                      saved("entrained", &N::entrained)};
  }
};

/// Told of what has moved so far.  Particles of all ranks that have moved are brought together at each look and added up in the order of their
/// ids, so that the same bits come of any number of ranks; maps, numbers and files are the root's.
template <int D>
class Runout {
 public:
  /// `spec` must outlive it; without one nothing is asked of anybody.
  Runout(std::filesystem::path folder, const std::optional<RunoutSpec>& spec);

  /// From the beginning of the first stage that is not geostatic on.  Every rank has to ask, here and below.
  void begin(const RunView<D>& view);
  bool has_begun() const noexcept { return begun_; }
  /// A look, if one is due or it is the last of a stage, and a view where these are wanted.  Returns the files of frames that it wrote.
  std::vector<std::string> see(const RunView<D>& view, bool last);
  /// The maps and sections as of the last look; their files, relative to the folder.
  std::vector<std::string> write_maps(const RunView<D>& view);

  /// Goes on with the files of a run whose state has been taken over.
  void go_on(const RunView<D>& view);
  /// On the root: frames that are later than the state are removed; whether runout.csv has all that had been written.
  bool drop_later() const;
  void flush() const;
  /// For the summary; none before the first look.
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
  struct Moved;
  struct CellValue;
  struct NamedMap {
    MapKind kind;
    std::vector<Real> values;
  };
  void lay_out(const RunView<D>& view);
  void look(const RunView<D>& view, bool with_frame);
  std::vector<Moved> gather_moved(const RunView<D>& view) const;
  template <class Pick>
  std::vector<Real> joined(Communicator& ranks, const std::vector<Real>& here, Pick&& pick) const;
  std::vector<Real> tops(const RunView<D>& view) const;
  void count_on_cells(const std::vector<Moved>& moved, Real since_start);
  void count_altogether(const std::vector<Moved>& moved);
  bool at_rest() const;
  std::array<Real, 2> on_plan(const Vec3& x) const;
  Real elevation(const Vec3& x) const { return axes_.sign * x[axes_.vertical]; }
  std::vector<CsvColumn> columns() const, columns_of_file() const;
  std::vector<Real> row(Real time) const;
  std::array<Real, 2> on_map(const std::array<Real, 2>& place) const;
  Raster raster(const std::vector<Real>& values, std::string_view unit) const;
  std::vector<NamedMap> maps() const;
  std::filesystem::path frame_file(int n) const;
  std::string section_text(const std::vector<std::array<Real, 2>>& places, const std::vector<Real>& distances) const;

  std::filesystem::path folder_;
  const std::optional<RunoutSpec>& spec_;
  PlanAxes axes_;
  PlanGrid grid_;
  std::optional<MapFrame> map_;
  Real moved_ = 0, threshold_ = 0;  // of the spec, or what goes without saying [m]
  std::optional<HistoryFile> file_;

  bool begun_ = false;
  Real start_ = 0;  // when it began [s]
  Schedule times_, frame_times_;
  int frames_ = 0;
  Real time_ = -1;  // of the last look [s]
  RunoutNumbers now_;
  Real fastest_ = 0, thickest_ = 0;  // so far [m/s], [m]
  Real still_since_ = 0;             // since when it has been at rest, infinite while it is not [s]
  std::vector<Real> ground_, base_, surface_, surface_max_, thickness_, thickness_max_, speed_max_, intensity_max_, arrival_, source_,
      erosion_;
};

extern template PlanAxes plan_axes<2>(const Vec<2>&);
extern template PlanAxes plan_axes<3>(const Vec<3>&);
extern template class Runout<2>;
extern template class Runout<3>;

}  // namespace talus
