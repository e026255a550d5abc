// A wall of 1.2 spacings counts for fluid as one of ten does.
#include "sim/walls/sheet.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/make/solid.h"
#include "scenes/sample.h"
#include "sim/math/kernels.h"
#include "sim/walls/wall_particles.h"
#include "tests/physics/lab.h"

namespace slosh {
namespace {

constexpr double kSpacing = 0.01;
constexpr double kFirstLayer = 0.48;  // spacings off a wall, where fluid is to stand

// What a plate's particles add to the density half a spacing over the middle of its upper face: the kernel's
// shape, mean over the places, in units of the rest lattice's for one particle in its middle.
double density_over_plate(double thick, ParticleModel model = ParticleModel::kCorrected) {
  lab::SceneBuilder b;
  b.scene.model = model;
  b.add_fluid(1000.0, 0.05);
  b.add_fixed("plate", make::box({-0.06, -thick, -0.06}, {0.06, 0.0, 0.06}));
  b.add_volume(make::box({-0.06, 0.02, -0.06}, {0.06, 0.05, 0.06}));
  b.set_domain({-0.2, -0.3, -0.2}, {0.2, 0.2, 0.2});
  const SampledScene sampled = sample_scene(b.scene, kSpacing).value();
  const Plan plan = make_plan(b.scene, kSpacing);
  const std::vector<SurfaceParticle> sheet = surface_particles(b.scene, sampled, plan, BodyMotion::kFixed);
  constexpr int kPlaces = 12;
  double sum = 0.0;
  for (int i = 0; i < kPlaces * kPlaces; ++i) {
    const glm::vec3 at(0.06 * (i / kPlaces + 0.5) / kPlaces - 0.03, kFirstLayer * kSpacing,
                       0.06 * (i % kPlaces + 0.5) / kPlaces - 0.03);
    for (const SurfaceParticle& p : sheet) {
      const glm::vec3 d = at - p.position;
      sum += p.pressure * spiky_shape<double>(glm::dot(d, d), p.reach);
    }
  }
  return sum / (kPlaces * kPlaces) / std::pow(2.0 * kSpacing, 3);
}

TEST(Sheet, AThinWallCountsAsAThickOneDoes) {
  const double thick = density_over_plate(0.1);
  for (const double spacings : {1.2, 1.3, 1.38, 1.4, 1.42, 1.5, 1.6, 1.8, 2.0, 2.2, 2.5, 3.2})
    EXPECT_NEAR(density_over_plate(spacings * kSpacing) / thick, 1.0, 0.05) << spacings << " spacings";
}

// The model without a correction is as it was, to compare with.
TEST(Sheet, TheConsistentModelKeepsItsWalls) {
  const double thick = density_over_plate(0.1, ParticleModel::kConsistent);
  EXPECT_GT(density_over_plate(1.02 * kSpacing, ParticleModel::kConsistent) / thick, 1.5);
}

}  // namespace
}  // namespace slosh
