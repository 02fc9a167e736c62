#pragma once
// A session of gmsh: silent, on one thread, with errors as SceneErrors.  One session at a time.
#include <functional>
#include <stdexcept>
#include <string>
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

  /// Calls f(); exceptions of gmsh become SceneErrors with the errors that it logged.  std::invalid_argument is passed on.
  template <class F>
  auto run(F&& f)
  {
    try {
      return f();
    } catch (const SceneErrors&) {
      throw;
    } catch (const std::invalid_argument&) {  // an error of the mesh, not of gmsh
      throw;
    } catch (const std::string& complaint) {  // gmsh 4.8 throws strings
      fail(complaint);
    } catch (const std::exception& complaint) {
      fail(complaint.what());
    }
  }
  [[noreturn]] void fail(const std::string& complaint) const;
  /// Throws if gmsh has logged an error, as it does not throw all of them.
  void check(const std::string& doing) const;

  /// Sets edge lengths: `spec.size` everywhere, less in the boxes of `spec.refine`.  `points_count`: sizes at the points of the geometry
  /// are used where they are smaller.
  template <int D>
  void set_sizes(const MeshSpec& spec, bool points_count);
  /// Sets edge lengths by position in a plane, none above `largest`.
  void set_sizes(const std::function<Real(Real x, Real y)>& size, Real largest);
  /// Meshes the current model: Frontal-Delaunay in 2-D, Delaunay in 3-D (HXT if Delaunay fails).
  void generate(int dimension);
  /// The cells and physical groups of the current model.
  template <int D>
  MeshData<D> take();

 private:
  std::vector<std::string> errors() const;  ///< errors that gmsh has logged
  SourceLocation asked_by_;
  int threads_;  ///< threads of the program: gmsh changes the number for the whole process
};

}  // namespace talus
