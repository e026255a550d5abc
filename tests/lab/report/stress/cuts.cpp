// Bodies that are cut: as often as they can be in fluid that moves, and by a blade that hardly a step sees.
#include <algorithm>
#include <cmath>

#include "sim/bodies/pieces.h"
#include "sim/math/format.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/stress/scenes.h"
#include "tests/lab/report/watch.h"

namespace slosh::report {
namespace {

constexpr double kKept = 1e-12;  // of mass and momentum, by a cut

// The body added last may become so many, which are right behind it.
void may_be_cut(Scene& scene, int pieces, double cut_n_m) {
  const int whole = static_cast<int>(scene.bodies.size()) - 1;
  scene.bodies.back().pieces = pieces;
  scene.bodies.back().cut_n_m = cut_n_m;
  for (int more = 2; more <= pieces; ++more) {
    Body piece = scene.bodies[static_cast<std::size_t>(whole)];
    piece.name += format("~%d", more);
    piece.pieces = 0;
    piece.piece_of = whole;
    piece.starts_away = true;
    scene.bodies.push_back(piece);
  }
}

// Of what there is of a body now.
struct Pieces {
  int count = 0;
  double mass = 0.0;         // kg
  glm::dvec3 momentum{0.0};  // kg·m/s
  double fastest = 0.0;      // m/s
  std::size_t heaviest = 0;  // its number
};

Pieces pieces_of(const Scene& scene, const World& world) {
  BodySnapshot now;
  world.fill(now);
  Pieces all;
  double most = 0.0;
  for (std::size_t b = 0; b < now.bodies.size(); ++b) {
    if (!is_cut(scene.bodies[b]) || now.bodies[b].gone) continue;
    const double mass = world.mass(b).mass;
    const glm::dvec3& velocity = now.bodies[b].twist.linear;
    all.count += 1;
    all.mass += mass;
    all.momentum += mass * velocity;
    all.fastest = std::max(all.fastest, glm::length(velocity));
    if (mass > most) most = mass, all.heaviest = b;
  }
  return all;
}

// How many fluid particles are more than `depth`, m, within what there is of bodies that may be cut.
std::size_t count_inside(const Scene& scene, const World& world, double depth) {
  Snapshot picture;
  world.fill(picture);
  std::size_t inside = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    if (!is_cut(body) || picture.rigid.bodies[b].gone) continue;
    const ConvexSolid solid = clipped(convex_solid(scene.meshes[static_cast<std::size_t>(body.mesh)]),
                                      planes_of(picture.rigid.cuts.get(), b));
    const Pose into = inverse(picture.rigid.bodies[b].pose);
    for (std::size_t p = 0; p < picture.positions.size(); ++p) {
      if (picture.fluid_index[p] == 255) continue;
      const glm::dvec3 at = transform_point(into, glm::dvec3(picture.positions[p]));
      inside += std::ranges::all_of(solid.faces, [&](const ConvexSolid::Face& face) {
        return glm::dot(face.normal, face.corners.front() - at) > depth;
      });
    }
  }
  return inside;
}

// A block of so many thousandths of the water's density in water that rushes to and fro, cut wherever it is
// heaviest until nothing of it is left to come.
template <int kPerMille>
Stress cut_afloat(const Setting& setting, Cost& cost) {
  constexpr int kPieces = 16;
  const glm::dvec3 half(0.05, 0.03, 0.04);
  SceneBuilder b;
  b.add_fluid(1000.0, 0.001);
  b.add_fixed("tank", tank_at_floor({0.24, 0.4, 0.16}, 0.03));
  const double whole = kPerMille * 8.0 * half.x * half.y * half.z;
  b.add_free("block", make::box(-half, half), whole, {{0.0, 0.135, 0.0}, {1, 0, 0, 0}});
  may_be_cut(b.scene, kPieces, 0.0);
  b.add_volume(make::box({-0.12, 0.0, -0.08}, {0.12, 0.1, 0.08}));
  b.scene.fluid_volumes.back().velocity = {0.5, 0.0, 0.0};
  b.set_domain({-0.4, -0.3, -0.4}, {0.4, 1.5, 0.4});
  Trial t(b.scene, setting, cost);
  const Diagnostics start = t.world().diagnostics();
  Watch watch(t, b.scene,
              start.kinetic_energy + whole * kGravity * 0.135 + 0.1 * start.mass * kGravity * start.center.y);
  double off_mass = 0.0, off_momentum = 0.0, fastest = 0.0;
  std::size_t through = 0;
  int turns = 0;
  watch.run(0.1);
  for (int i = 0; i < 60 && pieces_of(b.scene, t.world()).count < kPieces; ++i) {
    const Pieces before = pieces_of(b.scene, t.world());
    // Directions of which none comes again; a part may be too thin for one, or have too many faces.
    for (int tries = 0; tries < 20; ++tries) {
      const double turn = 2.4 * ++turns, up = std::sin(1.7 * turns);
      const double side = std::sqrt(1.0 - up * up);
      const glm::dvec3 normal(side * std::cos(turn), up, side * std::sin(turn));
      const CutPlane plane{normal, glm::dot(normal, t.world().mass(before.heaviest).center_of_mass)};
      if (t.world().cut(before.heaviest, plane)) break;
    }
    const Pieces after = pieces_of(b.scene, t.world());
    off_mass = std::max(off_mass, std::abs(after.mass - whole) / whole);
    const double scale = whole * std::max(before.fastest, 1e-3);
    off_momentum = std::max(off_momentum, glm::length(after.momentum - before.momentum) / scale);
    watch.run(0.03, [&] { fastest = std::max(fastest, pieces_of(b.scene, t.world()).fastest); });
    through = std::max(through, count_inside(b.scene, t.world(), setting.spacing));
  }
  const int made = pieces_of(b.scene, t.world()).count;
  watch.run(1.0);
  const Pieces late = pieces_of(b.scene, t.world());
  through = std::max(through, count_inside(b.scene, t.world(), setting.spacing));
  const Diagnostics end = t.world().diagnostics();
  const double flows = std::sqrt(2.0 * end.kinetic_energy / end.mass);
  Stress found = watch.found(1e-3);  // drops that spurt out between parts
  found.lost_share += static_cast<double>(through) / static_cast<double>(t.world().fluid_count());
  if (made < kPieces) found.broken = format("it became %d bodies", made);
  if (off_mass > kKept) found.broken = format("a cut changed the mass by %.2g", off_mass);
  if (off_momentum > kKept) found.broken = format("a cut changed the momentum by %.2g", off_momentum);
  if (!(fastest < 2.0)) found.broken = format("a piece went at %.2g m/s", fastest);
  // All float in what still sways.
  if (!(late.fastest < 4.0 * flows))
    found.broken = format("a piece goes at %.2g m/s in water of %.2g m/s", late.fastest, flows);
  if (late.count != made) found.broken = format("%d pieces are left", late.count);
  return found;
}

// A blade goes at 10 m/s through a block that nothing holds, 4 cm a step. What it gives it is its resistance
// for the time that the edge is inside; and nothing aside, though it is 1 cm thick: an overlap is undone and
// leaves no speed.
Stress struck(const Setting& setting, Cost& cost) {
  constexpr double kSpeed = 10.0, kResistance = 400.0, kStart = 0.1, kSeconds = 0.05;
  constexpr double kAside = 1e-6;
  const glm::dvec3 half(0.05, 0.03, 0.04);
  const double whole = 900.0 * 8.0 * half.x * half.y * half.z;
  SceneBuilder b;
  const int blade = b.add_fixed("blade", make::box({-0.1, 0.0, -0.005}, {0.1, 0.05, 0.005}));
  Body& moved = b.scene.bodies[static_cast<std::size_t>(blade)];
  moved.motion = BodyMotion::kDriven;
  moved.blade = true;
  moved.pose.position.y = kStart;
  moved.keys = {{0.0, moved.pose}, {kSeconds, {{0.0, kStart - kSpeed * kSeconds, 0.0}, {1, 0, 0, 0}}}};
  b.add_free("block", make::box(-half, half), whole);
  may_be_cut(b.scene, 2, kResistance);
  b.scene.gravity = glm::dvec3(0.0);
  b.set_domain(glm::dvec3(-1.0), glm::dvec3(1.0));
  Trial t(b.scene, setting, cost);
  double fastest = 0.0;
  t.run(kSeconds, [&] { fastest = std::max(fastest, pieces_of(b.scene, t.world()).fastest); });
  const Pieces after = pieces_of(b.scene, t.world());
  const double force = kResistance * 2.0 * half.x, away = force / whole;
  const double inside = (kSpeed - std::sqrt(kSpeed * kSpeed - 2.0 * away * 2.0 * half.y)) / away;
  const double expected = force * inside;
  Stress found;
  found.finite = all_finite(t.world());
  if (after.count != 2) found.broken = format("it is %d bodies", after.count);
  if (std::abs(after.mass - whole) > kKept * whole) found.broken = "its mass is another";
  if (!(std::abs(-after.momentum.y - expected) < 0.03 * expected))
    found.broken = format("it was given %.3g of %.3g N·s", -after.momentum.y, expected);
  if (!(std::hypot(after.momentum.x, after.momentum.z) < kAside * expected))
    found.broken = format("it was thrown aside by %.2g N·s", std::hypot(after.momentum.x, after.momentum.z));
  if (!(fastest < (1.0 + kAside) * glm::length(after.momentum) / whole))
    found.broken = format("a part went at %.3g m/s", fastest);
  return found;
}

}  // namespace

std::vector<StressCase> cut_stress() {
  return {
      {"cut_afloat", "A block in water that rushes about, cut into 16", 0.01, true, true, cut_afloat<600>},
      {"cut_cork", "The same of a quarter of the water's density", 0.01, true, true, cut_afloat<250>},
      {"struck", "A blade at 10 m/s through a block", 0.01, true, false, struck},
  };
}

}  // namespace slosh::report
