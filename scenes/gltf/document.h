// A glTF file, read and its structure checked: what every later stage may rely on.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenes/gltf/note.h"
#include "sim/math/pose.h"
#include "sim/math/result.h"

namespace slosh::gltf {

/// What was read. References between nodes, meshes, cameras, materials, accessors and buffer views are in
/// range; accessors' bounds are not yet checked (accessor.h does that on reading). Textures are in `looks`,
/// skins are left out.
struct Document {
  std::string file;  ///< as the user named it, for errors
  tinygltf::Model model;
  std::vector<int> nodes;              ///< of the default scene, parents before children
  std::vector<int> parent;             ///< by node; −1 for a root
  std::vector<glm::dmat4> world;       ///< by node: node frame to world, all parents applied, finite
  std::vector<nlohmann::json> extras;  ///< by node; an object, empty when the node has none
  nlohmann::json scene_extras;         ///< of the default scene; an object
  nlohmann::json looks;  ///< "materials" (a list of objects, where there), "textures", "samplers", "images":
                         ///< as they stand
  std::vector<Note> notes;     ///< what the file says and is left out (roles.h, ledger.h)
  bool quantized = false;      ///< meshes may have whole numbers (KHR_mesh_quantization)
  std::vector<bool> animated;  ///< by node: some channel of some animation moves it

  /// "file: node 'name'", as errors begin.
  std::string owner(int node) const;
  /// The node's name, or "#3" when it has none.
  std::string name(int node) const;
};

/// Nodes below each other, at most: whoever looks up from each for what carries it walks as far.
inline constexpr int kDeepestNodes = 1000;

/// Reads a .gltf or .glb. Errors: unreadable, not JSON, not glTF 2.0, a reference out of range, a loop of
/// nodes, nodes below more than kDeepestNodes others, a transform that is not finite, compressed geometry.
Result<Document> read_document(const std::filesystem::path& file);

/// Splits an affine matrix's linear part into a rotation and what is left of it (scale, shear, mirror), so
/// that linear = rotation · rest. False when it is singular.
bool split_rotation(const glm::dmat3& linear, glm::dquat& rotation, glm::dmat3& rest);

}  // namespace slosh::gltf
