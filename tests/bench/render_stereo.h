// Two eyes against one, timed.
#pragma once

#include <vector>

#include "render/renderer.h"

namespace slosh::bench {

/// Of at least one value.
double median(std::vector<double> values);

/// Both eyes of a frame, the HUD on a panel of its own every sixth time, as a headset at 60 Hz has it;
/// against one eye with the HUD over it. By turns, so that what else the machine does falls on both.
void time_stereo(Renderer& renderer, const Frame& frame, int frames);

}  // namespace slosh::bench
