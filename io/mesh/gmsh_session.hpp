#pragma once
// gmsh behind one door: silent, on one thread, its errors turned into SceneErrors.  One session at a time.
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "io/scene/scene.hpp"
#include "mesh/mesh.hpp"

namespace talus {

class GmshSession {
 public:
  explicit GmshSession(SourceLocation asked_by);
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

  /// f(); what gmsh throws becomes SceneErrors with the errors it logged.  std::invalid_argument passes through.
  template <class F>
  auto run(F&& f)
  {
    try {
      return f();
    } catch (const SceneErrors&) {
      throw;
    } catch (const std::invalid_argument&) {  // what is wrong with the mesh, not with gmsh
      throw;
    } catch (const std::string& complaint) {  // gmsh 4.8 throws these
      fail(complaint);
    } catch (const std::exception& complaint) {
      fail(complaint.what());
    }
  }
  [[noreturn]] void fail(const std::string& complaint) const;
  /// Throws if gmsh has logged an error: it does not throw them all.
  void check(const std::string& doing) const;

  /// Edge lengths: `spec.size` everywhere, less in the boxes of `spec.refine`.  `points_count`: sizes given at the points of the
  /// geometry hold where they are smaller.
  template <int D>
  void set_sizes(const MeshSpec& spec, bool points_count);
  /// Edge lengths by place in a plane, none above `largest`.
  void set_sizes(const std::function<Real(Real x, Real y)>& size, Real largest);
  /// Meshes the current model: Frontal-Delaunay in 2-D, Delaunay in 3-D (HXT where Delaunay fails).
  void generate(int dimension);
  /// The cells and physical groups of the current model.
  template <int D>
  MeshData<D> take();

 private:
  std::vector<std::string> errors() const;  ///< what gmsh logged as such
  SourceLocation asked_by_;
  int threads_;  ///< those of the program: gmsh sets the number for everybody
};

extern template void GmshSession::set_sizes<2>(const MeshSpec&, bool);
extern template void GmshSession::set_sizes<3>(const MeshSpec&, bool);
extern template MeshData<2> GmshSession::take<2>();
extern template MeshData<3> GmshSession::take<3>();

}  // namespace talus
