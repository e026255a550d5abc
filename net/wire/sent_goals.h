// The goals of a task on their way: a tree a step, and one list that travels.
#pragma once

#include "net/wire/acting_fields.h"

namespace slosh::wire {

/// From the steps into `goals`, which is empty.
void send_goals(PackedScene& packed);
/// The reverse. False where the goals do not fit the steps.
bool take_goals(PackedScene& packed);

}  // namespace slosh::wire
