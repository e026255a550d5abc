// Pieces of a convex body against closed forms.
#include "sim/bodies/pieces.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/tank.h"

namespace slosh {
namespace {

// Such that floats have them exactly.
const glm::dvec3 kBoxLower(-0.125, -0.0625, -0.25), kBoxUpper(0.125, 0.1875, 0.25);

ConvexSolid whole_box() {
  return convex_solid(testing::box_mesh(kBoxLower, kBoxUpper));
}

glm::dmat3 box_inertia(const glm::dvec3& size) {
  const glm::dvec3 square = size * size * (size.x * size.y * size.z / 12.0);
  glm::dmat3 inertia(0.0);
  for (int i = 0; i < 3; ++i) inertia[i][i] = square.x + square.y + square.z - square[i];
  return inertia;
}

double difference(const glm::dmat3& a, const glm::dmat3& b) {
  double most = 0.0;
  for (int i = 0; i < 3; ++i) most = std::max(most, glm::length(a[i] - b[i]));
  return most;
}

// About a point that is off the centre, by the parallel axes.
glm::dmat3 inertia_about(const SolidIntegrals& of, const glm::dvec3& point) {
  const glm::dvec3 d = of.center - point;
  return of.inertia + of.volume * (glm::dmat3(glm::dot(d, d)) - glm::outerProduct(d, d));
}

// A convex body of many faces: points on an ellipsoid by longitude and latitude.
TriangleMesh ellipsoid(const glm::dvec3& radii, int rings, int around) {
  TriangleMesh mesh;
  for (int r = 0; r <= rings; ++r) {
    for (int a = 0; a < around; ++a) {
      const double lat = std::numbers::pi * r / rings, lon = 2.0 * std::numbers::pi * a / around;
      const double wide = r == 0 || r == rings ? 0.0 : std::sin(lat);
      mesh.positions.emplace_back(radii *
                                  glm::dvec3(wide * std::cos(lon), std::cos(lat), -wide * std::sin(lon)));
    }
  }
  const auto at = [&](int r, int a) { return static_cast<unsigned>(r * around + a % around); };
  for (int r = 0; r < rings; ++r) {
    for (int a = 0; a < around; ++a) {
      mesh.triangles.emplace_back(at(r, a), at(r + 1, a), at(r + 1, a + 1));
      mesh.triangles.emplace_back(at(r, a), at(r + 1, a + 1), at(r, a + 1));
    }
  }
  return mesh;
}

glm::dvec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

TEST(Pieces, ABoxHasItsVolumeItsCentreAndItsInertia) {
  const SolidIntegrals box = integrate(whole_box());
  const glm::dvec3 size = kBoxUpper - kBoxLower;
  EXPECT_NEAR(box.volume, size.x * size.y * size.z, 1e-16);
  EXPECT_LT(glm::length(box.center - 0.5 * (kBoxLower + kBoxUpper)), 1e-15);
  EXPECT_LT(difference(box.inertia, box_inertia(size)), 1e-17);
}

TEST(Pieces, ABoxHalvedIsTwoBoxes) {
  for (int axis = 0; axis < 3; ++axis) {
    CutPlane plane{glm::dvec3(0.0), 0.03};
    plane.normal[axis] = 1.0;
    glm::dvec3 size = kBoxUpper - kBoxLower, center = 0.5 * (kBoxLower + kBoxUpper);
    for (const CutPlane& side : {plane, plane.reversed()}) {
      const double lower = side.normal[axis] > 0.0 ? kBoxLower[axis] : 0.03;
      const double upper = side.normal[axis] > 0.0 ? 0.03 : kBoxUpper[axis];
      size[axis] = upper - lower;
      center[axis] = 0.5 * (lower + upper);
      const ConvexSolid piece = clipped(whole_box(), side, 0);
      const SolidIntegrals half = integrate(piece);
      EXPECT_NEAR(half.volume, size.x * size.y * size.z, 1e-16);
      EXPECT_LT(glm::length(half.center - center), 1e-15);
      EXPECT_LT(difference(half.inertia, box_inertia(size)), 1e-17);
      EXPECT_NEAR(extent_along(piece, plane.normal).length(), size[axis], 1e-16);
    }
  }
}

// Through four corners: the plane goes along edges.
TEST(Pieces, ABoxCutFromEdgeToEdgeIsTwoPrisms) {
  const glm::dvec3 size = kBoxUpper - kBoxLower, middle = 0.5 * (kBoxLower + kBoxUpper);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(size.y, size.x, 0.0));
  const CutPlane plane{normal, glm::dot(normal, middle)};
  const SolidIntegrals a = integrate(clipped(whole_box(), plane, 0));
  const SolidIntegrals b = integrate(clipped(whole_box(), plane.reversed(), 0));
  for (const SolidIntegrals& prism : {a, b}) {
    EXPECT_NEAR(prism.volume, 0.5 * size.x * size.y * size.z, 1e-16);
    EXPECT_NEAR(std::abs(prism.center.x - middle.x), size.x / 6.0, 1e-14) << "a third of the height";
    EXPECT_NEAR(std::abs(prism.center.y - middle.y), size.y / 6.0, 1e-14);
  }
}

TEST(Pieces, WhatAPlaneMissesIsWholeOrNothing) {
  const CutPlane beyond{{0, 1, 0}, 0.2}, on_face{{0, 1, 0}, kBoxUpper.y};
  const double volume = integrate(whole_box()).volume;
  EXPECT_EQ(integrate(clipped(whole_box(), beyond, 0)).volume, volume);
  EXPECT_TRUE(clipped(whole_box(), beyond.reversed(), 0).faces.empty());
  EXPECT_EQ(integrate(clipped(whole_box(), on_face, 0)).volume, volume);
  EXPECT_EQ(integrate(clipped(whole_box(), on_face.reversed(), 0)).volume, 0.0);
  EXPECT_TRUE(section(whole_box(), beyond).empty());
}

TEST(Pieces, OfRandomCutsAddUpToTheWhole) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.2, 0.8);
  const std::array solids{whole_box(), convex_solid(ellipsoid({0.1, 0.05, 0.2}, 12, 24))};
  for (const ConvexSolid& solid : solids) {
    const SolidIntegrals whole = integrate(solid);
    std::vector<ConvexSolid> pieces{solid};
    for (int cut = 0; cut < 15; ++cut) {
      const std::size_t which = random() % pieces.size();
      const glm::dvec3 normal = random_direction(random);
      const Extent extent = extent_along(pieces[which], normal);
      const CutPlane plane{normal, glm::mix(extent.least, extent.most, share(random))};
      pieces.push_back(clipped(pieces[which], plane.reversed(), cut));
      pieces[which] = clipped(pieces[which], plane, cut);
      double volume = 0.0;
      glm::dvec3 moment(0.0);
      glm::dmat3 inertia(0.0);
      for (const ConvexSolid& piece : pieces) {
        const SolidIntegrals of = integrate(piece);
        EXPECT_GT(of.volume, 0.0);
        volume += of.volume;
        moment += of.volume * of.center;
        inertia += inertia_about(of, whole.center);
      }
      EXPECT_NEAR(volume / whole.volume, 1.0, 1e-12);
      EXPECT_LT(glm::length(moment / whole.volume - whole.center), 1e-13);
      EXPECT_LT(difference(inertia, whole.inertia), 1e-12 * glm::length(whole.inertia[0]));
    }
  }
}

// A closed surface has no area in sum, whichever way it is turned.
TEST(Pieces, AreClosed) {
  std::mt19937 random(3);
  ConvexSolid piece = convex_solid(ellipsoid({0.1, 0.05, 0.2}, 12, 24));
  for (int cut = 0; cut < static_cast<int>(kMaxCutPlanes); ++cut) {
    const glm::dvec3 normal = random_direction(random);
    const Extent extent = extent_along(piece, normal);
    piece = clipped(piece, {normal, glm::mix(extent.least, extent.most, 0.7)}, cut);
    glm::dvec3 sum(0.0);
    double all = 0.0;
    for (const ConvexSolid::Face& face : piece.faces) {
      for (std::size_t i = 1; i + 1 < face.corners.size(); ++i) {
        const glm::dvec3 area =
            0.5 * glm::cross(face.corners[i] - face.corners[0], face.corners[i + 1] - face.corners[0]);
        EXPECT_GT(glm::dot(area, face.normal), -2e-10) << "floats make the mesh convex to so much";
        sum += area;
        all += glm::length(area);
      }
    }
    EXPECT_LT(glm::length(sum), 1e-13 * all);
  }
}

TEST(Pieces, ASectionIsWhereThePlaneGoesThrough) {
  const std::vector<glm::dvec3> outline = section(whole_box(), {{0, 0, 1}, 0.1});
  glm::dvec3 area(0.0);
  for (std::size_t i = 1; i + 1 < outline.size(); ++i)
    area += 0.5 * glm::cross(outline[i] - outline[0], outline[i + 1] - outline[0]);
  EXPECT_NEAR(area.z, 0.25 * 0.25, 1e-16) << "counter-clockwise about the normal";
  for (const glm::dvec3& p : outline) EXPECT_NEAR(p.z, 0.1, 1e-16);
}

// Samples of a box's six faces, a lattice each.
SurfaceSamples box_samples(double apart) {
  SurfaceSamples all;
  all.apart = static_cast<float>(apart);
  all.particle_volume = static_cast<float>(std::pow(apart, 3));
  const glm::dvec3 size = kBoxUpper - kBoxLower;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (double a = 0.5 * apart; a < size[u]; a += apart) {
      for (double b = 0.5 * apart; b < size[v]; b += apart) {
        for (const double side : {0.0, size[axis]}) {
          glm::dvec3 at(0.0), normal(0.0);
          at[u] = a, at[v] = b, at[axis] = side;
          normal[axis] = side > 0.0 ? 1.0 : -1.0;
          all.positions.emplace_back(kBoxLower + at);
          all.normals.emplace_back(normal);
        }
      }
    }
  }
  return all;
}

TEST(Pieces, CutFacesHaveSamplesAsDenseAsTheRest) {
  constexpr double kApart = 1.0 / 64.0;
  const SurfaceSamples whole = box_samples(kApart);
  const std::array planes{CutPlane{glm::normalize(glm::dvec3(0.3, 1.0, 0.2)), 0.07},
                          CutPlane{glm::normalize(glm::dvec3(-1.0, 0.4, 0.6)), 0.02}};
  const ConvexSolid piece = clipped(whole_box(), planes);
  const SurfaceSamples samples = samples_within(whole, planes, piece);
  EXPECT_LT(samples.positions.size(), whole.positions.size()) << "a convex part has less surface";
  for (int number = 0; number < 2; ++number) {
    double area = 0.0;
    for (const ConvexSolid::Face& face : piece.faces) {
      if (face.plane != number) continue;
      for (std::size_t i = 1; i + 1 < face.corners.size(); ++i)
        area += 0.5 * glm::length(glm::cross(face.corners[i] - face.corners[0],
                                             face.corners[i + 1] - face.corners[0]));
    }
    std::vector<glm::dvec3> on_face;
    for (std::size_t i = 0; i < samples.positions.size(); ++i) {
      if (glm::distance(samples.normals[i], glm::vec3(planes[number].normal)) > 1e-6f) continue;
      on_face.emplace_back(samples.positions[i]);
      EXPECT_NEAR(planes[number].distance(on_face.back()), 0.0, 1e-7);
      EXPECT_LT(planes[1 - number].distance(on_face.back()), 1e-7) << "within the other plane";
    }
    EXPECT_NEAR(static_cast<double>(on_face.size()) * kApart * kApart / area, 1.0, 0.05);
    for (std::size_t i = 0; i < on_face.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) EXPECT_GT(glm::distance(on_face[i], on_face[j]), 0.9 * kApart);
  }
}

TEST(Pieces, ARectangleIsCoveredUpToItsEdges) {
  constexpr double kApart = 1.0 / 64.0;
  const std::array planes{CutPlane{{0, 1, 0}, 0.0625}};
  const SurfaceSamples samples = samples_within(box_samples(kApart), planes, clipped(whole_box(), planes));
  std::size_t on_face = 0;
  for (const glm::vec3& normal : samples.normals) on_face += normal.y > 0.5f;
  EXPECT_EQ(on_face, 16u * 32u);
}

TEST(Pieces, AFieldIsTheLargerOfItsOwnAndThePlanes) {
  DistanceField field{{-0.5f, -0.5f, -0.5f}, 0.0625f, {17, 17, 17}, {}};
  field.distance.resize(17 * 17 * 17);
  for_each_node(field.view(), [&](float, const glm::vec3& p, int node) {
    field.distance[static_cast<std::size_t>(node)] = glm::length(p) - 0.4f;
  });
  const std::array planes{CutPlane{{1, 0, 0}, 0.1}, CutPlane{{0, -1, 0}, 0.05}};
  const DistanceField cut = field_within(field, planes);
  for (const glm::vec3& p : {glm::vec3(0.0f), glm::vec3(0.25f, 0.0f, 0.0f), glm::vec3(0.0f, -0.25f, 0.1f)}) {
    const float ball = sample_distance(field.view(), p).distance;
    EXPECT_NEAR(sample_distance(cut.view(), p).distance, std::max({ball, p.x - 0.1f, -p.y - 0.05f}), 1e-2f);
  }
}

TEST(Pieces, HaveTheCornersOfTheirCuts) {
  EXPECT_EQ(corners_of(whole_box()).points.size(), 8u * 3u);
  const Corners half = corners_of(clipped(whole_box(), CutPlane{{0, 1, 0}, 0.01}, 0));
  EXPECT_EQ(half.points.size(), 8u * 3u);
  const Corners without_one =
      corners_of(clipped(whole_box(), CutPlane{glm::normalize(glm::dvec3(1)), 0.25}, 0));
  EXPECT_EQ(without_one.points.size(), (7u + 3u) * 3u);
}

}  // namespace
}  // namespace slosh
