// What decorates and what the physics is made of, from a glTF's JSON, before anything follows its references.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenes/gltf/note.h"

namespace slosh::gltf {

/// Of each mesh, whether the physics is made of it: a node with slosh = "body", "fluid" or "region" has it.
/// Of a root that is damaged what can be seen.
std::vector<bool> physical_meshes(const nlohmann::json& root);

/// A mesh of which nothing is left has this member, and no node.
inline constexpr char kLeftOut[] = "slosh_left_out";

/// Takes out of `root` what only decorates and would break the reading: attributes that nobody reads, parts
/// of pictures that are no triangles or have no data, animations of nodes that are nobody's and lead nowhere.
/// What the physics is made of stays as it is, for check_references to judge. Returns what is seen to be
/// missing.
std::vector<Note> drop_broken_looks(const std::string& file, nlohmann::json& root);

}  // namespace slosh::gltf
