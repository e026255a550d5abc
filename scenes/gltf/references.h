// References in glTF JSON: indices that the library underneath follows without looking.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "sim/math/result.h"

namespace slosh::gltf {

/// Checks that every index points at something (nodes → meshes, cameras, children; primitives → accessors and
/// materials; accessors → buffer views → buffers; animations → samplers, accessors, nodes; scenes → nodes)
/// and that the needed extensions are understood.
std::optional<Error> check_references(const std::string& file, const nlohmann::json& json);

/// What textures.h reads, before drop_unused: "materials", "textures" and "samplers", unchecked but for that
/// materials are objects.
nlohmann::json take_looks(const nlohmann::json& json);

/// Drops what the library underneath is not to see, so that it can neither slow the reading nor break it:
/// images, textures, samplers of textures, skins, and materials' references to textures.
void drop_unused(nlohmann::json& json);

}  // namespace slosh::gltf
