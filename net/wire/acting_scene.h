// What acts, comes and goes in a scene, between the scene and the lists that travel.
#pragma once

#include "net/wire/acting_fields.h"

namespace slosh::wire {

/// Into `cut`, whose lists are empty.
void fill_acting(const Scene& scene, CutScene& cut);
/// The reverse, into the scene that came with it; `comes`, `is_cut`: with what is behind ActingScene, behind
/// ComingScene. Returns what does not fit, empty where all does.
std::string take_acting(CutScene& cut, bool comes, bool is_cut, Scene& scene);

}  // namespace slosh::wire
