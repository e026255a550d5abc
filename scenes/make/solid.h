// Closed surfaces made of simple shapes: what the shipped scenes are built from.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scenes/scene.h"

namespace slosh::make {

/// A closed surface of shared vertices, counter-clockwise seen from outside. m.
struct Solid {
  std::vector<glm::dvec3> points;
  std::vector<glm::uvec3> triangles;
};

/// A polyline (r, y) turned about the y axis. Counter-clockwise with r to the right and y up: the solid lies
/// to the left of the way. It either begins and ends on the axis (r = 0) or is a closed ring off the axis.
Solid lathe(const std::vector<glm::dvec2>& profile, int segments);

/// Replaces each corner sharper than about 25° by a curve that begins and ends `radius` away from it (less on
/// short edges). Corners on the axis and the ends of the line stay.
std::vector<glm::dvec2> round_corners(const std::vector<glm::dvec2>& profile, double radius, int steps);

Solid box(const glm::dvec3& low, const glm::dvec3& high);
/// A box open at the top: the hollow is `inner` in size, stands on y = wall, centred on x = z = 0.
Solid tank(const glm::dvec3& inner, double wall);
Solid sphere(double radius, int rings, int segments);
/// A rod with round ends along y, from `from` to `to` (the ends of the axis' straight part).
Solid capsule(double radius, double from, double to, int rings, int segments);
/// A tube with flat ends along a path whose points are apart and turn gently.
Solid tube(const std::vector<glm::dvec3>& path, double radius, int segments);

/// Moves every point; a matrix that mirrors also turns the triangles.
Solid transformed(Solid solid, const glm::dmat4& matrix);
/// Both, side by side: two closed parts of one body.
Solid merged(Solid a, const Solid& b);

/// Vertices split where faces meet at more than `crease_deg`, smooth normals elsewhere.
TriangleMesh with_normals(const Solid& solid, double crease_deg = 40.0);

}  // namespace slosh::make
