// Scene-linear Rec.709 light → the display's code values, by OpenColorIO: its own shader text, or baked into
// a table that a shader looks up.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "sim/math/result.h"

namespace slosh {

/// Nodes a side of the table.
inline constexpr int kDisplayTableSize = 40;

/// What a user's configuration makes of `asked`: names filled in. Errors: no such file, a file that is no
/// configuration, a display or a view that it has not (with those that it has), no way from our light to it.
Result<ColorConfig> find_display_view(const ColorConfig& asked);

/// Applies the display transform to colours one by one, exactly, on the CPU: what the table approximates.
/// Errors: OpenColorIO lacks a transform.
Result<std::vector<glm::vec3>> display_colors(Display display, std::span<const glm::vec3> linear,
                                              const ColorConfig& color = {});

/// The table: kDisplayTableSize³ colours, red fastest. Node (r, g, b) holds the display colour of the
/// scene-linear colour display_unshape(r / (size − 1)), … (shaders/display_shaper.glsl). Errors as
/// display_colors.
Result<std::vector<glm::vec3>> make_display_table(Display display, const ColorConfig& color = {});

/// OpenColorIO's own GLSL 4 of the transform: `vec4 display_color(vec4 light)` of scene-linear light >= 0,
/// alpha any, exact but for rounding, not limited to 0–1. None where it would need textures of its own, which
/// is where the table is the smaller one. Errors as display_colors.
Result<std::optional<std::string>> display_shader(Display display, const ColorConfig& color = {});

}  // namespace slosh
