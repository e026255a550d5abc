#include "sim/bodies/contact_memory.h"

#include <algorithm>
#include <utility>

namespace slosh {

namespace {

std::pair<int, int> pair_of(const KeptImpulse& k) {
  return {k.first, k.second};
}

// Where a contact is on the body that carries it.
KeptImpulse place(const Contact& c, const std::vector<RigidBody>& bodies) {
  KeptImpulse k{std::min(c.a, c.b), std::max(c.a, c.b), {}, {}};
  const RigidBody& body = bodies[k.carrier(bodies)];
  k.point = glm::conjugate(body.orientation) * (c.point - body.position);
  return k;
}

}  // namespace

glm::dvec3 ContactMemory::recall(const Contact& contact, const std::vector<RigidBody>& bodies) const {
  const KeptImpulse here = place(contact, bodies);
  const std::span<const KeptImpulse> known = between(contact.a, contact.b);
  const auto distance = [&](const KeptImpulse& k) { return glm::distance(k.point, here.point); };
  const auto nearest =
      std::min_element(known.begin(), known.end(),
                       [&](const KeptImpulse& x, const KeptImpulse& y) { return distance(x) < distance(y); });
  if (nearest == known.end() || distance(*nearest) > reach_) return glm::dvec3(0.0);
  return contact.a == here.first ? nearest->impulse : -nearest->impulse;
}

glm::dvec3 ContactMemory::recall(const Contact& contact, std::size_t place, std::size_t count,
                                 const std::vector<RigidBody>& bodies) const {
  const std::span<const KeptImpulse> known = between(contact.a, contact.b);
  if (known.size() != count) return recall(contact, bodies);
  return contact.a < contact.b ? known[place].impulse : -known[place].impulse;
}

std::span<const KeptImpulse> ContactMemory::between(int body, int other) const {
  KeptImpulse wanted;
  wanted.first = std::min(body, other);
  wanted.second = std::max(body, other);
  const auto before = [](const KeptImpulse& x, const KeptImpulse& y) { return pair_of(x) < pair_of(y); };
  const auto [first, last] = std::equal_range(kept_.begin(), kept_.end(), wanted, before);
  return {first, last};
}

void ContactMemory::part(int body, int piece, const CutPlane& plane, const std::vector<RigidBody>& before,
                         const std::vector<RigidBody>& after) {
  const Pose to_mesh = inverse(before[static_cast<std::size_t>(body)].mesh_pose());
  for (KeptImpulse& k : kept_) {
    if (k.first != body && k.second != body) continue;
    const glm::dvec3 where = k.place(before);
    if (plane.distance(transform_point(to_mesh, where)) > 0.0) {
      (k.first == body ? k.first : k.second) = piece;
      if (k.first > k.second) {
        std::swap(k.first, k.second);
        k.impulse = -k.impulse;
      }
    }
    const RigidBody& carrier = after[static_cast<std::size_t>(k.carrier(after))];
    k.point = glm::conjugate(carrier.orientation) * (where - carrier.position);
  }
  std::stable_sort(kept_.begin(), kept_.end(),
                   [](const KeptImpulse& x, const KeptImpulse& y) { return pair_of(x) < pair_of(y); });
}

void ContactMemory::add(const Contact& contact, const glm::dvec3& impulse_on_a,
                        const std::vector<RigidBody>& bodies) {
  KeptImpulse k = place(contact, bodies);
  k.impulse = contact.a == k.first ? impulse_on_a : -impulse_on_a;
  kept_.push_back(k);
}

}  // namespace slosh
