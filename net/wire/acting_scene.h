// What acts, comes and goes in a scene, between the scene and the lists that travel.
#pragma once

#include "net/wire/acting_fields.h"

namespace slosh::wire {

/// Into `coming`, whose lists are empty.
void fill_acting(const Scene& scene, ComingScene& coming);
/// The reverse, into the scene that came with it; `comes`: with what is behind ActingScene. False where goals
/// do not fit the steps.
bool take_acting(ComingScene& coming, bool comes, Scene& scene);

}  // namespace slosh::wire
