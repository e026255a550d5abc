// How large a person wants the HUD's letters.
#pragma once

namespace slosh {

/// Of every HUD of this process, times what fits the picture (1). A property of whoever looks on, not of a
/// picture; from the next picture on. `scale` from 0.5 to 4; any thread.
void set_hud_scale(float scale);

}  // namespace slosh
