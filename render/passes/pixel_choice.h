// Whether passes over pixels are quicker as compute shaders than as fragments: found out by trying.
#pragma once

#include "render/context.h"

namespace slosh {

/// Times one of them, a surface filter over a made-up surface, both ways; once a process for each graphics
/// driver. Fragments where the driver refuses either, and where the difference is small, so that pictures of
/// one machine stay bitwise identical. The context must be current.
bool compute_is_quicker(const Context& context);

}  // namespace slosh
