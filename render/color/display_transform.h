// Scene-linear Rec.709 light → sRGB code values, by OpenColorIO, baked into a table that a shader looks up.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/renderer.h"
#include "sim/math/result.h"

namespace slosh {

/// Nodes a side of the table.
inline constexpr int kDisplayTableSize = 40;

/// Applies the display transform to colours one by one, exactly, on the CPU: what the table approximates.
/// Errors: OpenColorIO lacks a transform.
Result<std::vector<glm::vec3>> display_colors(Display display, std::span<const glm::vec3> linear);

/// The table: kDisplayTableSize³ colours, red fastest. Node (r, g, b) holds the display colour of the
/// scene-linear colour display_unshape(r / (size − 1)), … (shaders/display_shaper.glsl). Errors as
/// display_colors.
Result<std::vector<glm::vec3>> make_display_table(Display display);

}  // namespace slosh
