// Blades on their way through bodies that may be cut. Inside one nothing but its resistance stops the edge: a
// contact of a largest impulse, below which the blade stands and at which it moves on.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "sim/bodies/contact_rows.h"
#include "sim/bodies/cut_bodies.h"

namespace slosh {

/// kRefused: it went through, and the body could not be cut. kParting: it did and it was, and the blade,
/// which is thicker than a cut, is still beside that part.
enum class CutStage : std::uint8_t { kCutting, kRefused, kParting };

/// A blade that entered a body. In the body's mesh frame, as it was then: the body is cut along one plane.
struct Incision {
  int blade = 0, body = 0;
  CutPlane plane;       ///< the blade's
  glm::dvec3 way{0.0};  ///< unit, along the plane: to where the edge cuts
  double front{};       ///< m along the way: how far the edge came
  CutStage stage{CutStage::kCutting};
};

class Blades {
 public:
  explicit Blades(const Scene& scene, double spacing);

  bool any() const { return !blades_.empty(); }
  /// Which blades are in which bodies in this sub-step of `dt` s, and what resists them, added to `contacts`.
  void find(const std::vector<RigidBody>& bodies, const std::vector<BodySolve>& solves, const CutBodies& cuts,
            double dt, std::vector<Contact>& contacts);
  /// Pairs whose contacts find() has, the lower index first.
  const std::set<std::pair<int, int>>& pairs() const { return pairs_; }

  /// One before whose edge nothing of the body is left.
  std::optional<Incision> through(const std::vector<RigidBody>& bodies, const CutBodies& cuts) const;
  /// The body is another than it was.
  void forget(int body);
  void refuse(const Incision& incision);
  /// The body was cut, and these are its parts.
  void part(const Incision& through, int body, int piece);
  /// Contacts between a blade and a part that it pushes aside act across the cut alone, without friction, as
  /// long as there are any: near its edge the nearest way out of it is ahead, and what it cut would stop it.
  void push_aside(const std::vector<RigidBody>& bodies, std::vector<Contact>& contacts);

  const std::vector<Incision>& kept() const { return incisions_; }
  void restore(std::vector<Incision> kept) { incisions_ = std::move(kept); }

 private:
  struct Blade {
    int body = 0;
    glm::dvec3 ends[2];   // of the edge, m, mesh frame
    double height = 0.0;  // m, of the blade over its edge
  };
  struct Seen;
  std::optional<Seen> see(const Blade& blade, const Incision& incision, const std::vector<RigidBody>& bodies,
                          const CutBodies& cuts) const;
  std::optional<Incision> enter(const Blade& blade, int body, const std::vector<RigidBody>& bodies,
                                const std::vector<BodySolve>& solves, const CutBodies& cuts, double dt) const;
  void resist(const Blade& blade, const Incision& incision, const Seen& seen,
              const std::vector<RigidBody>& bodies, double resistance, double dt,
              std::vector<Contact>& contacts) const;

  double spacing_;
  std::vector<Blade> blades_;
  std::vector<Incision> incisions_;  // blade by blade, of each by body
  std::set<std::pair<int, int>> pairs_;
};

}  // namespace slosh
