// The shaders' own maths, compiled as C++: what a unit test calls is what a pixel runs.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace slosh::shader {

using glm::vec2;
using glm::vec3;
using glm::vec4;

using glm::abs;
using glm::clamp;
using glm::cross;
using glm::dot;
using glm::exp;
using glm::exp2;
using glm::length;
using glm::log2;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::pow;
using glm::smoothstep;
using glm::sqrt;

#define SHARED inline
#include "render/shaders/bilateral.glsl"
#include "render/shaders/display_shaper.glsl"
#include "render/shaders/narrow_range.glsl"
#include "render/shaders/optics.glsl"
#include "render/shaders/sphere.glsl"
#undef SHARED

}  // namespace slosh::shader
