// Bodies that rest on and bump into each other and the fixed scene: each body's surface particles against the
// other's distance field, solved at velocity level by projected Gauss–Seidel.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "scenes/scene.h"
#include "sim/bodies/contact_memory.h"
#include "sim/bodies/contact_rows.h"

namespace slosh {

class JointSystem;

/// Finds contacts between bodies of which at least one is free, none gone, and that no joint holds. A pair
/// gets at most kMaxContactsPerPair, spread over the touching patch. Deterministic.
class ContactFinder {
 public:
  static constexpr int kMaxContactsPerPair = 16;

  ContactFinder(const Scene& scene, const SampledScene& sampled);
  /// From now on these pairs are not tried, the lower index first.
  void leave_out(std::set<std::pair<int, int>> joined) { joined_ = std::move(joined); }

  /// Points closer than `margin` (m) to the other body's surface, and those that come as close within `dt` s
  /// at the speeds that `solves` has found so far, however fast. Of a patch's points those that `memory` has
  /// come first. `contacts` is cleared first.
  /// Pairs of `elsewhere`, the lower index first, are left out: blades that cut (blades.h).
  void find(const std::vector<RigidBody>& bodies, const std::vector<BodySolve>& solves, double margin,
            double dt, const ContactMemory& memory, std::vector<Contact>& contacts,
            const std::set<std::pair<int, int>>& elsewhere = {});

  /// Of a body's surface, in its mesh frame; none of a probe.
  std::span<const glm::vec3> points(int body) const { return shapes_[static_cast<std::size_t>(body)].points; }
  /// Another surface of a body: what is left of it, or all of it as it was at first where that is null.
  struct NewShape {
    std::vector<glm::vec3> points, normals;  ///< samples, then corners
    DistanceField field;
  };
  void set_shape(int body, const NewShape* shape);
  DistanceFieldView field(int body) const { return shapes_[static_cast<std::size_t>(body)].field.view(); }

 private:
  // Points that lie together.
  struct Cluster {
    glm::vec3 center{0.0f};  // mesh frame
    float radius = 0.0f;     // m
    std::vector<std::uint32_t> points;
  };
  struct Shape {
    std::vector<glm::vec3> points;   // surface particles, mesh frame
    std::vector<glm::vec3> normals;  // theirs, outward
    std::vector<char> flat;          // 1: all of its neighbours on the same face have its normal
    std::vector<Cluster> clusters;   // all points, each in one
    DistanceField field;
    glm::vec3 lower{0.0f}, upper{0.0f};  // bounds of the points, mesh frame
    double radius = 0.0;                 // of the points about the mesh frame's origin, m
  };
  // What a search works on.
  struct Motion {
    const std::vector<RigidBody>& bodies;
    const std::vector<BodySolve>& solves;
    double margin, dt;
    glm::dvec3 velocity_at(int body, const glm::dvec3& where) const;
    double fastest(int body, double radius) const;  // of any point, m/s
  };
  void drop_misleading();
  void keep_spread(const std::vector<RigidBody>& bodies, std::span<const KeptImpulse> known,
                   std::vector<Contact>& contacts);
  void points_against_field(const Motion& motion, int points_of, int field_of, double reach);
  void measure(Shape& shape) const;
  static void cluster(const std::vector<glm::vec3>& points, std::span<std::uint32_t> which,
                      std::vector<Cluster>& out);

  std::vector<Shape> shapes_;
  std::map<int, Shape> whole_;            // of bodies that were cut
  std::set<std::pair<int, int>> joined_;  // the lower index first
  double spacing_;
  std::vector<std::uint64_t> near_;  // a bit for each point that may be near the other body
  std::vector<Contact> found_;
  std::vector<double>
      facing_;  // one for each found: how squarely the two surfaces face each other, 1 = fully
};

/// Changes the solved velocities so that no contact closes faster than its gap allows, with Coulomb friction
/// and restitution. `materials` and `solves` have one entry a body; fixed bodies' are not used. Overlap is
/// undone at a bounded rate. Begins with what `memory` has of the last step, and leaves what this one gave.
/// `joints`, where there are any: after their begin(); their motors and stops are solved too, and every
/// impulse acts with all joints kept.
void solve_contacts(const std::vector<Contact>& contacts, const std::vector<ContactMaterial>& materials,
                    const std::vector<RigidBody>& bodies, double time_step, ContactMemory& memory,
                    std::vector<BodySolve>& solves, JointSystem* joints = nullptr);

}  // namespace slosh
