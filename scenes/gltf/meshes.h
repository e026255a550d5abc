// A node's mesh as one indexed triangle list.
#pragma once

#include <cstddef>

#include "scenes/gltf/document.h"
#include "scenes/scene.h"

namespace slosh::gltf {

/// All triangles of one scene file together, at most.
inline constexpr std::size_t kMaxTriangles = 2'000'000;
/// All vertices and indices that are read for one scene file, each as often as some mesh asks for it: many
/// meshes may share one accessor.
inline constexpr std::size_t kMaxNumbersRead = 6 * kMaxTriangles;
/// m, of places along each axis: particles are kept in floats, which are a millimetre apart there.
inline constexpr double kFarthest = 1e4;

/// Vertices and indices that read_mesh goes through.
std::size_t work_of_mesh(const Document& document, int mesh);

/// All primitives of glTF mesh `mesh` joined, with `rest` (scale, shear, mirror) baked in. Where there are no
/// normals faces are shaded flat, as glTF has it; texture coordinates are read where the mesh's material has
/// textures. `where` is "file: node 'x'". Errors: anything out of bounds, not triangles, too many triangles.
Result<TriangleMesh> read_mesh(const Document& document, int mesh, const glm::dmat3& rest,
                               const std::string& where);

}  // namespace slosh::gltf
