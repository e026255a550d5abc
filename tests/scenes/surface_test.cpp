// Surface samples: how many, how even, how complete.
#include "scenes/sampling/surface.h"

#include <cmath>
#include <cstdio>
#include <random>

#include "scenes/make/shipped.h"
#include "scenes/make/solid.h"
#include "scenes/mesh/closed.h"
#include "scenes/sample.h"
#include "support.h"

namespace slosh {
namespace {

struct Evenness {
  double mean = 0.0;       ///< of the distances to the nearest sample on the same sheet, in spacings
  double variation = 0.0;  ///< their standard deviation over their mean
  double least = 0.0;      ///< in spacings
};

Evenness evenness(const SurfaceSamples& samples, double spacing) {
  double sum = 0.0;
  double squares = 0.0;
  double least = 1e9;
  const std::size_t n = samples.positions.size();
  for (std::size_t i = 0; i < n; ++i) {
    double near = 1e9;
    for (std::size_t j = 0; j < n; ++j) {
      if (i == j || glm::dot(samples.normals[i], samples.normals[j]) < -0.3f) continue;
      near = std::min<double>(near, glm::distance(samples.positions[i], samples.positions[j]));
    }
    sum += near;
    squares += near * near;
    least = std::min(least, near);
  }
  const double mean = sum / static_cast<double>(n);
  return {mean / spacing, std::sqrt(std::max(0.0, squares / static_cast<double>(n) - mean * mean)) / mean,
          least / spacing};
}

/// The farthest that a point of the exposed surface is from a sample, in spacings, over many random points.
double largest_gap(const TriangleMesh& mesh, const SurfaceSamples& samples, double spacing) {
  const mesh::MeshTree tree(mesh);
  std::mt19937 bits(3);
  std::uniform_real_distribution<double> random(0.0, 1.0);
  const double share = mesh::surface_area(mesh) / 20000.0;
  double due = 0.0;
  double walked = 0.0;
  double gap = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::dvec3 a(mesh.positions[mesh.triangles[t].x]);
    const glm::dvec3 b(mesh.positions[mesh.triangles[t].y]);
    const glm::dvec3 c(mesh.positions[mesh.triangles[t].z]);
    walked += 0.5 * glm::length(glm::cross(b - a, c - a));
    for (; due < walked; due += share) {
      const double root = std::sqrt(random(bits));
      const double v = random(bits);
      const glm::vec3 p((1 - root) * a + root * (1 - v) * b + root * v * c);
      if (tree.inside(p + tree.face_normal(static_cast<int>(t)) * static_cast<float>(1e-3 * spacing)))
        continue;
      float near = INFINITY;
      for (const glm::vec3& s : samples.positions) near = std::min(near, glm::distance(p, s));
      gap = std::max(gap, near / spacing);
    }
  }
  return gap;
}

void expect_even(const TriangleMesh& mesh, const SurfaceSamples& samples, double spacing,
                 double exposed_area) {
  const double wanted = exposed_area / (spacing * spacing);
  EXPECT_NEAR(static_cast<double>(samples.positions.size()), wanted, 0.15 * wanted);
  const Evenness even = evenness(samples, spacing);
  EXPECT_LT(even.variation, 0.2);
  EXPECT_GE(even.least, 0.599);
  EXPECT_GT(even.mean, 0.8);
  const double gap = largest_gap(mesh, samples, spacing);
  EXPECT_LT(gap, 0.8);
  ::testing::Test::RecordProperty("variation", std::to_string(even.variation));
  std::printf(
      "    %zu samples (%.0f wanted), nearest %.3f spacings, variation %.3f, least %.3f, largest gap %.3f\n",
      samples.positions.size(), wanted, even.mean, even.variation, even.least, gap);
  EXPECT_NEAR(samples.particle_volume * static_cast<double>(samples.positions.size()), exposed_area * spacing,
              0.02 * exposed_area * spacing);
}

TEST(SurfaceSampling, Sphere) {
  const TriangleMesh mesh = make::with_normals(make::sphere(0.1, 32, 64));
  const SurfaceSamples samples = sampling::sample_surface(mesh, mesh::MeshTree(mesh), 1, 0.01);
  expect_even(mesh, samples, 0.01, mesh::surface_area(mesh));
  for (std::size_t i = 0; i < samples.positions.size(); ++i) {
    EXPECT_NEAR(glm::length(samples.positions[i]), 0.1f, 5e-4f);
    EXPECT_GT(glm::dot(samples.normals[i], glm::normalize(samples.positions[i])), 0.99f);
  }
}

TEST(SurfaceSampling, BoxOfTwelveTriangles) {
  const TriangleMesh mesh = make::with_normals(make::box({0, 0, 0}, {0.3, 0.2, 0.1}));
  const SurfaceSamples samples = sampling::sample_surface(mesh, mesh::MeshTree(mesh), 1, 0.012);
  expect_even(mesh, samples, 0.012, mesh::surface_area(mesh));
}

TEST(SurfaceSampling, ThinWalledTank) {
  const TriangleMesh mesh = make::with_normals(make::tank({0.2, 0.12, 0.16}, 0.014));
  const SurfaceSamples samples = sampling::sample_surface(mesh, mesh::MeshTree(mesh), 1, 0.012);
  expect_even(mesh, samples, 0.012, mesh::surface_area(mesh));
}

TEST(SurfaceSampling, BucketWithHandles) {
  const test::TempFolder folder;
  ASSERT_TRUE(make::make_bucket().write(folder / "bucket.gltf"));
  const auto scene = load_scene(folder / "bucket.gltf");
  ASSERT_TRUE(scene) << scene.error().text();
  const auto sampled = sample_scene(scene.value(), 0.01);
  ASSERT_TRUE(sampled) << sampled.error().text();
  const SurfaceSamples& samples = sampled.value().surfaces[1];
  // The handles' ends are buried in the wall: the area that counts is what the samples stand for.
  const TriangleMesh& mesh = scene.value().meshes[scene.value().bodies[1].mesh];
  const double exposed = samples.particle_volume * static_cast<double>(samples.positions.size()) / 0.01;
  EXPECT_LT(exposed, mesh::surface_area(mesh));
  EXPECT_GT(exposed, 0.97 * mesh::surface_area(mesh));
  expect_even(mesh, samples, 0.01, exposed);
}

// Bumps brake what slides: along a fixed body that slips the samples lie nearer to each other.
TEST(SurfaceSampling, AreFinerWhereBumpsWouldBrake) {
  Scene scene;
  Body body;
  EXPECT_DOUBLE_EQ(boundary_spacing(scene, body, 0.01), 0.01) << "at which fluid stands still";
  body.dynamic_viscosity = kFreeSlip;
  EXPECT_DOUBLE_EQ(boundary_spacing(scene, body, 0.01), 0.007) << "along which it slides";
  body.motion = BodyMotion::kFree;
  EXPECT_DOUBLE_EQ(boundary_spacing(scene, body, 0.01), 0.01) << "what moves";
  body.motion = BodyMotion::kFixed;
  scene.model = ParticleModel::kPaper;
  EXPECT_DOUBLE_EQ(boundary_spacing(scene, body, 0.01), 0.01) << "a model whose walls are as published";
}

// The area that they stand for is the surface's, whatever their distance. Two bodies of one mesh may differ.
TEST(SurfaceSampling, FinerSamplesStandForTheSameArea) {
  const test::TempFolder folder;
  ASSERT_TRUE(make::make_bucket().write(folder / "bucket.gltf"));
  Scene scene = load_scene(folder / "bucket.gltf").value();
  scene.bodies.push_back(scene.bodies[1]);
  scene.bodies.back().name = "smooth";
  scene.bodies.back().motion = BodyMotion::kFixed;
  scene.bodies.back().dynamic_viscosity = kFreeSlip;
  scene.bodies.back().pose.position.x += 1.0;
  const SampledScene sampled = sample_scene(scene, 0.01).value();
  const SurfaceSamples &plain = sampled.surfaces[1], &fine = sampled.surfaces.back();
  EXPECT_FLOAT_EQ(plain.apart, 0.01f);
  EXPECT_FLOAT_EQ(fine.apart, 0.007f);
  const auto volume = [](const SurfaceSamples& s) {
    return s.particle_volume * static_cast<float>(s.positions.size());
  };
  EXPECT_NEAR(volume(fine) / volume(plain), 1.0, 0.01);
  EXPECT_NEAR(static_cast<double>(fine.positions.size()) / static_cast<double>(plain.positions.size()),
              1.0 / 0.49, 0.06);
}

TEST(SurfaceSampling, BuriedSurfaceGetsNone) {
  const make::Solid rod = make::capsule(0.03, -0.3, 0.3, 8, 24);
  const TriangleMesh mesh = make::with_normals(make::merged(make::sphere(0.1, 24, 48), rod));
  const SurfaceSamples samples = sampling::sample_surface(mesh, mesh::MeshTree(mesh), 2, 0.012);
  for (const glm::vec3& p : samples.positions) {
    const bool in_ball = glm::length(p) < 0.098f;
    const bool in_rod = std::hypot(p.x, p.z) < 0.0295f && std::abs(p.y) < 0.3f;
    EXPECT_FALSE(in_ball || in_rod) << p.x << " " << p.y << " " << p.z;
  }
}

TEST(SurfaceSampling, RepeatsToTheBit) {
  const TriangleMesh mesh = make::with_normals(make::sphere(0.1, 16, 32));
  const mesh::MeshTree tree(mesh);
  const SurfaceSamples a = sampling::sample_surface(mesh, tree, 1, 0.02);
  const SurfaceSamples b = sampling::sample_surface(mesh, tree, 1, 0.02);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
}

}  // namespace
}  // namespace slosh
