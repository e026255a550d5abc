// What a glTF says that slosh does not do, of the kinds that its JSON shows: one list, for `check` and a run.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenes/gltf/note.h"

namespace slosh::gltf {

/// Skins, shape keys with a weight, hidden nodes, instancing, channels of animations that move no hand,
/// lights, further materials of a mesh, extensions of materials, scenes beside the one that is read: of the
/// scene that is read alone. Precondition: check_references found nothing. A kind that comes often is named
/// so many times, then counted.
std::vector<Note> ledger(const std::string& file, const nlohmann::json& root);

/// Of each kind the first kMaxOfAKind; the last of these says how many there are.
std::vector<Note> shortened(std::vector<Note> notes);
inline constexpr std::size_t kMaxOfAKind = 8;

}  // namespace slosh::gltf
