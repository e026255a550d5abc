// The planes in which a wall mirrors the fluid, by what its samples' normals are.
#include "sim/walls/mirror_planes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/make/solid.h"
#include "scenes/sample.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/physics/lab.h"

namespace slosh {
namespace {

constexpr double kSpacing = 0.005;                             // m
constexpr float kReach = 2.0f * static_cast<float>(kSpacing);  // m

SurfaceSamples samples_of(const make::Solid& solid) {
  lab::SceneBuilder b;
  b.add_fluid(1000.0, 5.0);
  b.set_viscosity({b.add_fixed("wall", solid)}, kFreeSlip);
  b.add_volume(make::box({-0.01, 0.21, -0.01}, {0.01, 0.23, 0.01}), 0);
  b.set_domain({-1.0, -0.5, -1.0}, {1.0, 1.0, 1.0});
  return sample_scene(b.scene, kSpacing).value().surfaces[0];
}

glm::vec3 normal_at(const MirrorPlane& plane, const glm::vec3& off) {
  const Vector3<float> turned = times(plane.bend, off.x, off.y, off.z);
  return glm::normalize(plane.normal + glm::vec3(turned.x, turned.y, turned.z));
}

// Its edges are edges: the planes on either side are each the face's own.
TEST(MirrorPlanes, OfABoxAreItsFaces) {
  const SurfaceSamples box = samples_of(make::box({-0.04, 0.0, -0.03}, {0.04, 0.05, 0.03}));
  const std::vector<MirrorPlane> planes = mirror_planes(box.positions, box.normals, kReach);
  ASSERT_EQ(planes.size(), box.positions.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    EXPECT_LT(glm::distance(planes[i].normal, box.normals[i]), 1e-5f);
    for (const float b : {planes[i].bend.xx, planes[i].bend.xy, planes[i].bend.xz, planes[i].bend.yy,
                          planes[i].bend.yz, planes[i].bend.zz})
      EXPECT_LT(std::abs(b), 1e-3f) << "1/m";
  }
}

// A tube of 64 flat faces is round to them: what turns in it meets no corner. Its samples' own normals are up
// to 2.8° off.
TEST(MirrorPlanes, OfAGlassAreRound) {
  constexpr double kRadius = 0.05;
  const SurfaceSamples glass = samples_of(report::glass_of(kRadius, 0.1, 0.03));
  const std::vector<MirrorPlane> planes = mirror_planes(glass.positions, glass.normals, kReach);
  double worst = 0.0, worst_beside = 0.0, mean_own = 0.0;
  int inside = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const glm::vec3& p = glass.positions[i];
    const double radius = std::hypot(p.x, p.z);
    if (std::abs(radius - kRadius) > 0.05 * kRadius || p.y < 0.015f || p.y > 0.085f) continue;
    ++inside;
    const glm::vec3 axis_ward = -glm::normalize(glm::vec3(p.x, 0.0f, p.z));
    worst = std::max<double>(worst, glm::distance(planes[i].normal, axis_ward));
    mean_own += glm::distance(glass.normals[i], axis_ward);
    // Fluid a spacing to the side and half a one off the wall.
    const glm::vec3 beside = glm::cross(axis_ward, glm::vec3(0, 1, 0));
    const glm::vec3 fluid = p + static_cast<float>(kSpacing) * (beside + 0.5f * axis_ward);
    worst_beside = std::max<double>(
        worst_beside,
        glm::distance(normal_at(planes[i], fluid - p), -glm::normalize(glm::vec3(fluid.x, 0.0f, fluid.z))));
  }
  ASSERT_GT(inside, 500);
  std::printf("normals off by %.4f at most, %.4f a spacing beside; samples' own by %.4f in the mean\n", worst,
              worst_beside, mean_own / inside);
  EXPECT_LT(worst, 0.03);
  EXPECT_LT(worst_beside, 0.04);
}

}  // namespace
}  // namespace slosh
