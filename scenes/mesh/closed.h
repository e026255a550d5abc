// Is a mesh the boundary of a volume? And which volume.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scenes/mesh/weld.h"

namespace slosh::mesh {

/// What keeps a mesh from bounding a volume. Edges are counted on the welded mesh.
struct Defects {
  std::size_t open_edges = 0;     ///< edges with one triangle: a hole's border
  std::size_t crowded_edges = 0;  ///< edges with more than two triangles that do not bound wedges of solids
  std::size_t flipped_edges = 0;  ///< edges whose two triangles face opposite ways
  glm::dvec3 where{0.0};          ///< the middle of the first such edge, m, mesh frame

  bool any() const { return open_edges + crowded_edges + flipped_edges > 0; }
};

/// Triangles of a mesh that hang together by edges. Where solids touch along an edge each goes its own way:
/// the triangles around it are paired by the wedges of solid between them.
struct Components {
  int count = 0;
  bool touching = false;         ///< some edge is shared by more than two triangles
  std::vector<int> of_triangle;  ///< one a triangle, 0 … count − 1
};

/// Finds both in one pass over the edges.
Defects find_defects(const WeldedMesh& mesh, Components* components = nullptr);

/// Integrals over the closed volume: sums of signed parts, so a part that faces inward is a cavity.
struct VolumeIntegrals {
  double volume = 0.0;       ///< m³
  glm::dvec3 centroid{0.0};  ///< m
  glm::dmat3 inertia{0.0};   ///< of density 1 kg/m³ about the centroid, kg·m²
};

/// Takes out pairs of triangles that cover each other and face opposite ways: what two solids that touch have
/// between them bounds nothing. Returns whether there were any; then `welded`, which is of `mesh`, is of it
/// no more.
bool drop_inner_faces(TriangleMesh& mesh, const WeldedMesh& welded);

/// Walks the faces of an OpenMesh surface. `component` −1 takes all. Precondition: no defects.
VolumeIntegrals integrate_volume(const WeldedMesh& mesh, const Components& components, int component = -1);

/// Area of all triangles, m².
double surface_area(const TriangleMesh& mesh);

}  // namespace slosh::mesh
