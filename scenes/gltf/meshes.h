// A node's mesh as one indexed triangle list, and its material.
#pragma once

#include "scenes/gltf/document.h"
#include "scenes/scene.h"

namespace slosh::gltf {

/// All triangles of one scene file together, at most.
inline constexpr std::size_t kMostTriangles = 2'000'000;

/// All primitives of glTF mesh `mesh` joined, with `rest` (scale, shear, mirror) baked in. Missing normals
/// are made. `where` is "file: node 'x'". Errors: anything out of bounds, not triangles, too many triangles.
Result<TriangleMesh> read_mesh(const Document& document, int mesh, const glm::dmat3& rest,
                               const std::string& where);

/// The material of the mesh's first primitive that has one; the default otherwise.
Material read_material(const Document& document, int mesh);

}  // namespace slosh::gltf
