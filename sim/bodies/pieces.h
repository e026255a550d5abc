// The pieces that a convex body is cut into: their solids, masses, surface samples and distance fields, all
// by the planes alone. No state.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scenes/scene.h"
#include "sim/bodies/corners.h"
#include "sim/math/cut_plane.h"

namespace slosh {

/// A closed convex polyhedron. Points that faces share are bitwise the same in each.
struct ConvexSolid {
  struct Face {
    std::vector<glm::dvec3> corners;  ///< m, counter-clockwise seen from outside; some may be in line
    glm::dvec3 normal{0.0};           ///< unit, outward
    int plane{-1};                    ///< of the cut that it comes from, by number; −1: the mesh's own
  };
  std::vector<Face> faces;  ///< none: nothing is left
};

/// Of a convex mesh (sim/math/convex.h), in its frame.
ConvexSolid convex_solid(const TriangleMesh& mesh);
/// What of it is on the plane's inner side. The new face gets `number`.
ConvexSolid clipped(const ConvexSolid& solid, const CutPlane& plane, int number);
/// By all planes, numbered as they come.
ConvexSolid clipped(const ConvexSolid& solid, std::span<const CutPlane> planes);

/// Of density 1 kg/m³.
struct SolidIntegrals {
  double volume{};          ///< m³
  glm::dvec3 center{0.0};   ///< m
  glm::dmat3 inertia{0.0};  ///< kg·m², about the centre
};
SolidIntegrals integrate(const ConvexSolid& solid);

/// How far it reaches along a direction, m.
struct Extent {
  double least{}, most{};
  double length() const { return most - least; }
};
Extent extent_along(const ConvexSolid& solid, const glm::dvec3& direction);

/// Where a plane goes through it: corners counter-clockwise about the plane's normal, m; none: it misses.
std::vector<glm::dvec3> section(const ConvexSolid& solid, const CutPlane& plane);

/// Of `whole`, samples of the mesh's surface, those within all planes; and on every cut face a grid of them.
/// `solid` is clipped by the planes.
SurfaceSamples samples_within(const SurfaceSamples& whole, std::span<const CutPlane> planes,
                              const ConvexSolid& solid);

/// Distances to what is within all planes: exact inside, and outside but for what is beyond an edge, where
/// they are too small. On the same grid.
DistanceField field_within(const DistanceField& whole, std::span<const CutPlane> planes);

Corners corners_of(const ConvexSolid& solid);

}  // namespace slosh
