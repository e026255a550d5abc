// How strongly a wall's particles drag, by how the surface is bent.
#include "sim/viscosity/wall_drag.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scenes/make/solid.h"
#include "sim/walls/wall_particles.h"
#include "tests/physics/lab.h"

namespace slosh {
namespace {

constexpr double kSpacing = 0.006;  // m

struct Volumes {
  float least = 1e9f, most = 0.0f;  // of the particles that drag, in what the surface's samples have
};

/// Of a body in honey.
Volumes volumes(const make::Solid& solid) {
  lab::SceneBuilder b;
  b.add_fluid(1000.0, 5.0);
  const int body = b.add_free("body", solid, 0.05, {{0.0, 0.3, 0.0}, {1, 0, 0, 0}});
  b.add_fixed("tank", lab::tank_at_floor({0.1, 0.1, 0.1}, 0.03));
  b.add_volume(make::box({-0.05, 0.0, -0.05}, {0.05, 0.05, 0.05}), 0);
  b.set_domain({-1.0, -0.5, -1.0}, {1.0, 1.0, 1.0});
  const SampledScene sampled = sample_scene(b.scene, kSpacing).value();
  const Plan plan = make_plan(b.scene, kSpacing);
  Volumes found;
  for (const SurfaceParticle& p : surface_particles(b.scene, sampled, plan, BodyMotion::kFree)) {
    if (p.pressure > 0.0f) continue;  // it presses
    const float share = p.volume / sampled.surfaces[static_cast<std::size_t>(body)].particle_volume;
    found.least = std::min(found.least, share);
    found.most = std::max(found.most, share);
  }
  return found;
}

TEST(WallDragTest, FluidAtAFlatWallLiesMostlyInLayersAtABallMostlyEvenly) {
  const WallDrag drag = wall_drag(ParticleModel::kCorrected, 2.0, DragLayer::kSurface);
  EXPECT_NEAR(drag.layered, 0.554, 0.005);
  EXPECT_NEAR(drag.even, 0.652, 0.005);
  EXPECT_NEAR(1.0 / drag.factor(0.0), 0.7 / drag.layered + 0.3 / drag.even, 1e-12);
  EXPECT_NEAR(1.0 / drag.factor(0.4), 0.1 / drag.layered + 0.9 / drag.even, 1e-12);
  EXPECT_DOUBLE_EQ(drag.factor(0.7), drag.factor(0.4));
  EXPECT_GT(drag.factor(0.2), drag.factor(0.0));
  EXPECT_LT(drag.factor(0.2), drag.factor(0.4));
}

TEST(WallDragTest, WherePressuresAreSolvedForItLiesInLayersAtABallHalfOfItEvenly) {
  const WallDrag drag = wall_drag(ParticleModel::kIncompressible, 2.0, DragLayer::kSurface);
  EXPECT_DOUBLE_EQ(drag.factor(0.0), drag.layered);
  EXPECT_NEAR(1.0 / drag.factor(0.4), 0.5 / drag.layered + 0.5 / drag.even, 1e-12);
  EXPECT_DOUBLE_EQ(drag.factor(0.7), drag.factor(0.4));
}

TEST(WallDragTest, FromBehindTheSurfaceAllSurfacesDragAlike) {
  const WallDrag drag = wall_drag(ParticleModel::kCorrected, 2.0, DragLayer::kBehind);
  EXPECT_DOUBLE_EQ(drag.factor(0.0), drag.factor(1.0));
}

// A mirror is the stiffer the more of it is within reach. Where walls drag from behind their surface there is
// none.
TEST(WallDragTest, AWallThatSlipsMakesUpForWhatAMirrorWouldTake) {
  const auto of = [](double ratio) { return mirror_factor(ratio, DragLayer::kSurface); };
  EXPECT_NEAR(of(2.0), 0.302, 0.001);
  EXPECT_LT(of(2.0), of(2.5));
  EXPECT_EQ(mirror_factor(2.0, DragLayer::kBehind), 0.0);
}

TEST(WallDragTest, ABoxDragsAsItsFacesDoAndABallMore) {
  const WallDrag drag = wall_drag(ParticleModel::kCorrected, 2.0, DragLayer::kSurface);
  const Volumes box = volumes(make::box(glm::dvec3(-0.02), glm::dvec3(0.02)));
  EXPECT_FLOAT_EQ(box.least, static_cast<float>(drag.factor(0.0))) << "edges too";
  EXPECT_FLOAT_EQ(box.most, static_cast<float>(drag.factor(0.0)));
  const Volumes ball = volumes(make::sphere(2.0 * kSpacing, 24, 48));
  EXPECT_FLOAT_EQ(ball.least, static_cast<float>(drag.factor(0.4)));
  EXPECT_FLOAT_EQ(ball.most, static_cast<float>(drag.factor(0.4)));
  const Volumes large = volumes(make::sphere(8.0 * kSpacing, 48, 96));  // bent by an eighth
  EXPECT_NEAR(large.least, drag.factor(0.125), 0.01);
  EXPECT_NEAR(large.most, drag.factor(0.125), 0.01);
}

}  // namespace
}  // namespace slosh
