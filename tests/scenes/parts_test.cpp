// Solids of several closed parts, as CAD unions write them: closed part by part, weighed as one.
#include <algorithm>
#include <cmath>

#include "foreign_kit.h"
#include "scenes/mesh/tree.h"
#include "scenes/mesh/united.h"
#include "scenes/sample.h"

namespace slosh {
namespace {

using make::Solid;

struct Parts {
  mesh::Defects defects;
  mesh::Components components;
  mesh::United united;
};

Parts take(TriangleMesh triangles) {
  Parts out;
  mesh::WeldedMesh welded = mesh::weld(triangles);
  if (mesh::drop_inner_faces(triangles, welded)) welded = mesh::weld(triangles);
  out.defects = mesh::find_defects(welded, &out.components);
  out.united = mesh::integrate_union(welded, out.components);
  return out;
}
Parts take(const Solid& solid) {
  return take(make::with_normals(solid));
}

/// The same box with each face cut along its other diagonal.
Solid other_diagonals(Solid box) {
  for (std::size_t i = 0; i + 1 < box.triangles.size(); i += 2) {
    const glm::uvec3 a = box.triangles[i], b = box.triangles[i + 1];
    // The corner of each that the other has not.
    const auto has = [](const glm::uvec3& t, unsigned v) { return t.x == v || t.y == v || t.z == v; };
    int own = 0, others = 0;
    for (int k = 0; k < 3; ++k) {
      if (!has(b, a[k])) own = k;
      if (!has(a, b[k])) others = k;
    }
    const unsigned tip = a[own], next = a[(own + 1) % 3], last = a[(own + 2) % 3], far = b[others];
    box.triangles[i] = {tip, next, far};
    box.triangles[i + 1] = {tip, far, last};
  }
  return box;
}

void expect_loads(const Solid& cup, double litres) {
  const test::TempFolder folder;
  const Solid water = make::box({-0.05, 0.5, -0.05}, {0.05, 0.6, 0.05});
  make::SceneWriter writer({{"title", "parts"}, {"domain_min_m", {-2, -2, -2}}, {"domain_max_m", {2, 2, 2}}});
  const int paint = writer.add_material("paint", {});
  writer.add_node("thing", writer.add_mesh("thing", cup, paint), {},
                  {{"slosh", "body"}, {"motion", "free"}, {"density_kg_m3", 1000.0}});
  writer.add_node("water", writer.add_mesh("water", water, paint), {}, {{"slosh", "fluid"}});
  ASSERT_TRUE(writer.write(folder / "parts.gltf"));
  const Result<Scene> scene = load_scene(folder / "parts.gltf");
  ASSERT_TRUE(scene) << scene.error().text();
  EXPECT_NEAR(scene.value().bodies[0].mass.mass, litres, 2e-3 * litres);
  const Result<SampledScene> sampled = sample_scene(scene.value(), 0.01);
  ASSERT_TRUE(sampled) << sampled.error().text();
  // Nothing of it lies inside: what fluid cannot reach has no particles.
  const mesh::MeshTree tree(scene.value().meshes[static_cast<std::size_t>(scene.value().bodies[0].mesh)]);
  const SurfaceSamples& surface = sampled.value().surfaces[0];
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const glm::vec3 p = surface.positions[i] + 1e-4f * surface.normals[i];
    // On an edge where solids touch either side may count: inside is what is so all around.
    bool inside = true;
    for (const glm::vec3 aside : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)})
      for (const float way : {-5e-5f, 5e-5f}) inside = inside && tree.inside(p + way * aside);
    EXPECT_FALSE(inside) << p.x << " " << p.y << " " << p.z;
  }
}

TEST(Parts, BoxesThatShareAFaceAreOneSolid) {
  const Solid left = make::box({-0.1, 0.0, 0.0}, {0.0, 0.1, 0.1});
  const Solid right = make::box({0.0, 0.0, 0.0}, {0.1, 0.1, 0.1});
  for (const Solid& both : {make::merged(left, right), make::merged(left, other_diagonals(right))}) {
    const Parts parts = take(both);
    EXPECT_FALSE(parts.defects.any()) << parts.defects.open_edges << " " << parts.defects.crowded_edges;
    EXPECT_NEAR(parts.united.solid.volume, 2e-3, 1e-8);
    EXPECT_NEAR(parts.united.solid.centroid.x, 0.0, 1e-7);
    EXPECT_EQ(parts.united.overlap, 0.0);
    expect_loads(both, 2.0);
  }
  const int alike = std::min(take(make::merged(left, right)).components.count,
                             take(make::merged(left, other_diagonals(right))).components.count);
  EXPECT_EQ(alike, 1) << "where both cut it alike, what was between them is gone";
}

TEST(Parts, BoxesThatShareAnEdgeOrACorner) {
  const Solid first = make::box({-0.1, -0.1, 0.0}, {0.0, 0.0, 0.1});
  const Parts edge = take(make::merged(first, make::box({0.0, 0.0, 0.0}, {0.1, 0.1, 0.1})));
  EXPECT_FALSE(edge.defects.any());
  EXPECT_EQ(edge.components.count, 2);
  EXPECT_NEAR(edge.united.solid.volume, 2e-3, 1e-8);
  expect_loads(make::merged(first, make::box({0.0, 0.0, 0.0}, {0.1, 0.1, 0.1})), 2.0);
  const Parts corner = take(make::merged(first, make::box({0.0, 0.0, 0.1}, {0.1, 0.1, 0.2})));
  EXPECT_FALSE(corner.defects.any());
  EXPECT_NEAR(corner.united.solid.volume, 2e-3, 1e-8);
}

TEST(Parts, ThreeAndFourBoxesAroundOneEdge) {
  Solid all = make::box({0.0, 0.0, 0.0}, {0.1, 0.1, 0.1});
  for (const auto& [x, y] : {std::pair{-0.1, 0.0}, {-0.1, -0.1}, {0.0, -0.1}}) {
    all = make::merged(all, make::box({x, y, 0.0}, {x + 0.1, y + 0.1, 0.1}));
    const Parts parts = take(all);
    EXPECT_FALSE(parts.defects.any()) << x << " " << y;
    EXPECT_NEAR(parts.united.solid.volume, 1e-3 * (static_cast<double>(all.triangles.size()) / 12.0), 1e-8);
  }
}

TEST(Parts, ASolidThatTouchesItselfAlongAnEdge) {
  // An open ring of boxes whose last meets the first along an edge.
  Solid ring;
  for (const auto& [x, y] :
       {std::pair{0.0, 0.0}, {-0.1, 0.0}, {-0.1, 0.1}, {-0.1, 0.2}, {0.0, 0.2}, {0.1, 0.2}, {0.1, 0.1}})
    ring = make::merged(ring, make::box({x, y, 0.0}, {x + 0.1, y + 0.1, 0.1}));
  const Parts parts = take(ring);
  EXPECT_FALSE(parts.defects.any());
  EXPECT_NEAR(parts.united.solid.volume, 7e-3, 1e-7);
  expect_loads(ring, 7.0);
}

TEST(Parts, WhatOverlapsCountsOnce) {
  const Parts two = take(make::merged(make::box({-0.1, 0.0, 0.0}, {0.02, 0.1, 0.1}),
                                      make::box({-0.02, 0.0, 0.0}, {0.1, 0.1, 0.1})));
  EXPECT_FALSE(two.defects.any());
  const double volume = 2e-3;  // together a box of 0.2 x 0.1 x 0.1
  EXPECT_NEAR(two.united.solid.volume, volume, 2e-3 * volume);
  EXPECT_NEAR(two.united.overlap, 4e-4, 4e-6);
  EXPECT_LT(glm::distance(two.united.solid.centroid, glm::dvec3(0.0, 0.05, 0.05)), 2e-4);
  const double along = volume / 12 * (0.01 + 0.01), across = volume / 12 * (0.04 + 0.01);
  EXPECT_NEAR(two.united.solid.inertia[0][0], along, 0.01 * along);
  EXPECT_NEAR(two.united.solid.inertia[1][1], across, 0.01 * across);
  EXPECT_NEAR(two.united.solid.inertia[2][2], across, 0.01 * across);
  EXPECT_NEAR(two.united.solid.inertia[0][1], 0.0, 0.01 * along);
}

TEST(Parts, OneInsideTheOtherIsOneSolidOrACavityByItsFaces) {
  Solid inner = make::sphere(0.05, 24, 48);
  const Solid outer = make::sphere(0.1, 24, 48);
  const double whole = take(outer).united.solid.volume;
  EXPECT_NEAR(take(make::merged(outer, inner)).united.solid.volume, whole, 2e-3 * whole);
  const double hollow = take(inner).united.solid.volume;
  for (glm::uvec3& t : inner.triangles) std::swap(t.y, t.z);
  EXPECT_NEAR(take(make::merged(outer, inner)).united.solid.volume, whole - hollow, 1e-9);
}

TEST(Parts, ASmallOverlapChangesNoDigit) {
  const Solid both = make::merged(make::box({-0.1, 0.0, 0.0}, {0.0005, 0.1, 0.1}),
                                  make::box({0.0, 0.0, 0.0}, {0.1, 0.1, 0.1}));
  const TriangleMesh triangles = make::with_normals(both);
  const mesh::WeldedMesh welded = mesh::weld(triangles);
  mesh::Components components;
  mesh::find_defects(welded, &components);
  EXPECT_EQ(mesh::integrate_union(welded, components).solid.volume,
            mesh::integrate_volume(welded, components).volume);
}

TEST(Parts, TheOverlapIsTold) {
  const Solid cup =
      make::merged(make::tank({0.1, 0.1, 0.1}, 0.02), make::box({-0.07, 0.0, -0.07}, {0.07, 0.02, 0.07}));
  const test::TempFolder folder;
  ASSERT_TRUE(test::make_cup({{"title", "x"}}, &cup).write(folder / "cup.gltf"));
  const Inspection found = inspect_scene(folder / "cup.gltf");
  ASSERT_TRUE(found.scene) << test::all_text(found.errors);
  const std::string all = test::all_text(found.warnings);
  EXPECT_NE(all.find("[parts-overlap]"), std::string::npos) << all;
  EXPECT_NE(all.find("0.39"), std::string::npos) << "litres: " << all;
}

TEST(Parts, AFinThatBoundsNothingIsStillRefused) {
  Solid cup = make::tank({0.1, 0.1, 0.1}, 0.02);
  const auto n = static_cast<unsigned>(cup.points.size());
  cup.points.emplace_back(0.2, 0.1, 0.0);
  cup.triangles.emplace_back(0u, 1u, n);
  EXPECT_TRUE(take(cup).defects.any());
}

}  // namespace
}  // namespace slosh
