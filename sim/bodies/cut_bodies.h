// Bodies that may be cut, and what is left of each.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/bodies/pieces.h"
#include "sim/math/body_cuts.h"
#include "sim/math/result.h"

namespace slosh {

/// All that a body's planes decide.
struct PieceShape {
  std::vector<CutPlane> planes;  ///< those that bound it; none: it is whole
  ConvexSolid solid;
  MassProperties mass;
  SurfaceSamples surface;
  DistanceField field;
};

/// What a scene says of bodies that may be cut; reading says it better, this is for scenes from elsewhere.
/// Error: one is not convex, or has too many triangles.
std::optional<Error> check_cut_bodies(const Scene& scene);

class CutBodies {
 public:
  /// The scene still has its meshes.
  CutBodies(const Scene& scene, const SampledScene& sampled);

  bool any() const { return !families_.empty(); }
  /// Whether cuts make anything of it.
  bool has(int body) const { return !family_of_.empty() && family_of_[static_cast<std::size_t>(body)] >= 0; }
  /// Bodies that a cut of this one may bring into the world, itself among them; only of those that has().
  const std::vector<int>& family(int body) const { return of(body).members; }
  /// N/m, what a blade needs for each metre inside it.
  double resistance(int body) const { return of(body).resistance; }
  /// What is left of it: in its mesh frame.
  const ConvexSolid& solid(int body) const { return states_[static_cast<std::size_t>(body)].solid; }
  const std::vector<CutPlane>& planes(int body) const {
    return states_[static_cast<std::size_t>(body)].planes;
  }
  std::vector<std::vector<CutPlane>> all_planes() const;
  /// From that tick on; null where every body is whole.
  std::shared_ptr<const BodyCuts> told(std::uint64_t since) const;

  /// What a body is within these planes. Errors: of more than kMaxCutPlanes, too thin, nothing.
  Result<PieceShape> shape(int body, std::vector<CutPlane> planes) const;
  void set(int body, const PieceShape& shape);

 private:
  struct Family {
    std::string name;
    std::vector<int> members;  // the first is the whole at the start
    double density = 0.0, resistance = 0.0;
    MassProperties mass;  // of the whole, by the scene
    ConvexSolid solid;
    SurfaceSamples surface;
    DistanceField field;
  };
  struct State {
    std::vector<CutPlane> planes;
    ConvexSolid solid;
    MassProperties mass;
  };
  const Family& of(int body) const {
    return families_[static_cast<std::size_t>(family_of_[static_cast<std::size_t>(body)])];
  }

  double spacing_;
  std::vector<Family> families_;
  std::vector<int> family_of_;  // one a body where there are any; −1: none
  std::vector<State> states_;   // likewise
};

}  // namespace slosh
