#pragma once
// history.csv: balances, reactions, tracked points, fronts and displacement of the mass at each output time.
#include <functional>

#include "app/observers/accounts.hpp"
#include "app/observers/body_forces.hpp"
#include "io/output/csv.hpp"
#include "io/scene/scene.hpp"

namespace talus {

/// The id of the particle of `spec.body` (any body, if empty) nearest to `spec.at`; the lowest of several equally near ones.  Collective.
template <int D>
std::int64_t nearest_particle(const PointSpec& spec, const RunView<D>& view);

/// The coordinate [m] along the direction of `spec` that the given fraction of the mass does not exceed.  NaN without particles.  Over all
/// ranks, on the root.  Collective.
template <int D>
Real front(const FrontSpec& spec, const RunView<D>& view);

/// The length of displacement [m] that the given fraction of the mass does not exceed.  Over all ranks, on the root.  Collective.
template <int D>
Real moved(const MovedSpec& spec, const RunView<D>& view);

/// The facets of a wall of the history; the second wall on a group is called GROUP_2.
template <int D>
std::optional<std::vector<Facet>> facets_of_wall(const Mesh<D>& mesh, const std::string& wall);

/// Columns at the end of the history that others compute, one value per column.
template <int D>
struct OwnColumns {
  std::vector<CsvColumn> columns;
  std::function<std::vector<Real>(const RunView<D>&)> row;
};

/// The data from earlier rows that a row needs.
template <int D>
struct HistoryState {
  std::vector<std::int64_t> followed;  ///< id of the particle of each point
  std::vector<Vec<D>> impulse;         ///< impulse of each wall at the previous row [N s]
  std::vector<Vec3> angular;           ///< moment of this impulse about the origin [N m s]
  std::vector<Vec<D>> contact;         ///< impulse of each contact, then of each cut, at the previous row [N s]
  std::vector<RigidSums<D>> rigid;     ///< of each rigid body at the previous row
  std::vector<BodyImpulse<D>> given;   ///< impulse on each body of the history at the previous row
  Real time = 0;                       ///< time of the previous row [s]
  static constexpr auto fields()
  {
    return std::tuple{saved("followed", &HistoryState::followed), saved("impulse", &HistoryState::impulse),
                      saved("angular", &HistoryState::angular),   saved("contact", &HistoryState::contact),
                      saved("rigid", &HistoryState::rigid),       saved("given", &HistoryState::given),
                      saved("time", &HistoryState::time)};
  }
};

/// Writes the history.  The root writes the file with data of all ranks.  The columns are those of io/output/history_columns.hpp.
/// Quantities without particles are NaN, written as empty entries: a point whose particle was deleted, the front or centre of mass of an
/// empty body.
template <int D>
class HistoryWriter {
 public:
  HistoryWriter(const std::filesystem::path& file, HistoryOutputSpec spec, OwnColumns<D> own, const RunView<D>& start);
  /// Continues an existing file after the time of `now`.
  HistoryWriter(const std::filesystem::path& file, HistoryOutputSpec spec, OwnColumns<D> own, const RunView<D>& now, HistoryState<D> state);
  const HistoryState<D>& state() const noexcept { return state_; }
  /// Points of this body now track the nearest particle.
  void follow_anew(const std::string& body, const RunView<D>& now);
  void append(const RunView<D>& view, const BalanceHistory<D>& accounts, const BodyForces<D>& forces);
  const HistoryFile& table() const noexcept { return *file_; }              ///< on the root
  const std::vector<Real>& last_row() const noexcept { return last_row_; }  ///< empty before the first row of this process
  Real last_time() const noexcept { return file_->last_time(); }            ///< time of the last row in the file [s], on the root
  static std::vector<CsvColumn> columns(const HistoryOutputSpec& spec, const RunView<D>& start);

 private:
  /// Adds the columns of a body: its sums, and the mean force on it; no force if that is unknown for a step.
  void add_body(const RunView<D>& view, const BodyForces<D>& forces, std::size_t k, Real elapsed, std::vector<Real>& row);
  void add_wall(const RunView<D>& view, const WallSpec& spec, Real elapsed, std::vector<Real>& row) const;
  void add_points(const RunView<D>& view, std::vector<Real>& row);

  HistoryOutputSpec spec_;
  OwnColumns<D> own_;
  HistoryState<D> state_;
  std::vector<Real> last_row_;
  std::optional<HistoryFile> file_;
};

extern template class HistoryWriter<2>;
extern template class HistoryWriter<3>;

}  // namespace talus
