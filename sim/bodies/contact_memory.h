// What contacts gave in the last sub-step: where the next solve begins. A weight passes through a stack of n
// bodies in some n² iterations of the solve; begun anew each step, a stack of ten never gets there and
// topples.
#pragma once

#include <span>
#include <vector>

#include "sim/bodies/contact_rows.h"
#include "sim/math/cut_plane.h"

namespace slosh {

/// One contact's part.
struct KeptImpulse {
  int first = 0, second = 0;  ///< bodies, the lower index first
  glm::dvec3 point{0.0};      ///< m, where it was, about the centre and along the axes of carrier()
  glm::dvec3 impulse{0.0};    ///< N·s on the first, world axes

  /// The body that its point goes along with: the first that is free.
  int carrier(const std::vector<RigidBody>& bodies) const { return bodies[first].free ? first : second; }
  /// Where it is now, world.
  glm::dvec3 place(const std::vector<RigidBody>& bodies) const {
    const RigidBody& body = bodies[carrier(bodies)];
    return body.position + body.orientation * point;
  }
};

class ContactMemory {
 public:
  /// `spacing`: the least distance between contacts of a pair, m.
  explicit ContactMemory(double spacing) : reach_(0.5 * spacing) {}

  /// N·s on contact.a, by the one that was within half a spacing of it; zero where there was none.
  glm::dvec3 recall(const Contact& contact, const std::vector<RigidBody>& bodies) const;
  /// Likewise where several are at one point: by its place among the pair's contacts, while there are as
  /// many as there were.
  glm::dvec3 recall(const Contact& contact, std::size_t place, std::size_t count,
                    const std::vector<RigidBody>& bodies) const;
  /// Those of two bodies, in the order in which they were chosen.
  std::span<const KeptImpulse> between(int body, int other) const;

  /// Forgets all; the contacts of a pair must then be added together, pairs in the order of their indices.
  void clear() { kept_.clear(); }
  void add(const Contact& contact, const glm::dvec3& impulse_on_a, const std::vector<RigidBody>& bodies);

  /// What `body` had beyond `plane`, in its mesh frame, is `piece`'s from now on: it was cut. `before`,
  /// `after`: all bodies then and now, all in the same places.
  void part(int body, int piece, const CutPlane& plane, const std::vector<RigidBody>& before,
            const std::vector<RigidBody>& after);

  const std::vector<KeptImpulse>& kept() const { return kept_; }
  void restore(std::vector<KeptImpulse> kept) { kept_ = std::move(kept); }

 private:
  double reach_;
  std::vector<KeptImpulse> kept_;  // pair by pair
};

}  // namespace slosh
