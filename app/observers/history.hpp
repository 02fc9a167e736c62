#pragma once
// history.csv: balances, reactions, followed points, fronts and how far the mass has moved at each output time.
#include "app/observers/accounts.hpp"
#include "app/observers/body_forces.hpp"
#include "io/output/csv.hpp"
#include "io/scene/scene.hpp"

namespace talus {

/// Id of the particle of `spec.body` (any, if empty) that is nearest to `spec.at`; of several equally near the lowest.  Every rank has to ask.
template <int D>
std::int64_t nearest_particle(const PointSpec& spec, const std::vector<Body>& bodies, const Particles<D>& particles,
                              Communicator& ranks = one_rank());

/// Coordinate [m] that a share of the mass does not pass, looking along the direction of `spec`.  NaN without particles.  Of all ranks, on the
/// root; every rank has to ask.
template <int D>
Real front(const FrontSpec& spec, const std::vector<Body>& bodies, const Particles<D>& particles, Communicator& ranks = one_rank());

/// Length of displacement [m] that a share of the mass does not exceed, alike.
template <int D>
Real moved(const MovedSpec& spec, const std::vector<Body>& bodies, const Particles<D>& particles, Communicator& ranks = one_rank());

/// The facets that a wall of the history stands on: the second wall on a group is called GROUP_2.
template <int D>
std::optional<std::vector<Facet>> facets_of_wall(const Mesh<D>& mesh, const std::string& wall);

/// What a row owes to the rows before.
template <int D>
struct HistoryState {
  std::vector<std::int64_t> followed;  ///< id of the particle of each point
  std::vector<Vec<D>> impulse;         ///< of each wall at the row before [N s]
  std::vector<Vec3> angular;           ///< its moment about the origin [N m s]
  std::vector<BodyImpulse<D>> given;   ///< to each body of the history, at the row before
  Real time = 0;                       ///< of the row before [s]
  static constexpr auto fields()
  {
    return std::tuple{saved("followed", &HistoryState::followed), saved("impulse", &HistoryState::impulse),
                      saved("angular", &HistoryState::angular), saved("given", &HistoryState::given), saved("time", &HistoryState::time)};
  }
};

/// The file is the root's; the other ranks give what it needs.  Columns: those of io/output/history_columns.hpp.  What has no particle any more has no value (NaN, an empty entry): a point whose particle was
/// deleted, the front of an empty body, the centre of mass of nothing.
template <int D>
class HistoryWriter {
 public:
  HistoryWriter(const std::filesystem::path& file, HistoryOutputSpec spec, const RunView<D>& start);
  /// Goes on in a file that is there, behind the time of `now`.
  HistoryWriter(const std::filesystem::path& file, HistoryOutputSpec spec, const RunView<D>& now, HistoryState<D> state);
  const HistoryState<D>& state() const noexcept { return state_; }
  /// Points of this body follow the particle that is nearest now.
  void follow_anew(const std::string& body, const RunView<D>& now);
  void append(const RunView<D>& view, const BalanceHistory<D>& accounts, const BodyForces<D>& forces);
  void flush() const { file_->flush(); }                          ///< on the root
  Real last_time() const noexcept { return file_->last_time(); }  ///< of the last row there [s], on the root
  static std::vector<CsvColumn> columns(const HistoryOutputSpec& spec, const RunView<D>& start);

 private:
  /// Of a body: its sums, and the mean force on it; no force where that is not known of a step.
  void add_body(const RunView<D>& view, const BodyForces<D>& forces, std::size_t k, Real elapsed, std::vector<Real>& row);
  void add_wall(const RunView<D>& view, const WallSpec& spec, Real elapsed, std::vector<Real>& row) const;
  static void add_point(const RunView<D>& view, const PointSpec& point, Index at, std::vector<Real>& row);

  HistoryOutputSpec spec_;
  HistoryState<D> state_;
  std::optional<HistoryFile> file_;
};

extern template std::optional<std::vector<Facet>> facets_of_wall<2>(const Mesh<2>&, const std::string&);
extern template std::optional<std::vector<Facet>> facets_of_wall<3>(const Mesh<3>&, const std::string&);
extern template class HistoryWriter<2>;
extern template class HistoryWriter<3>;

}  // namespace talus
