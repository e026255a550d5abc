// The shaders' own maths, compiled as C++: what a unit test calls is what a pixel runs.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <glm/integer.hpp>

namespace slosh::shader {

using glm::ivec3;
using glm::mat3;
using glm::uint;
using glm::vec2;
using glm::vec3;
using glm::vec4;

using glm::abs;
using glm::ceil;
using glm::clamp;
using glm::cross;
using glm::determinant;
using glm::dot;
using glm::exp;
using glm::exp2;
using glm::findMSB;
using glm::length;
using glm::log2;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::pow;
using glm::refract;
using glm::smoothstep;
using glm::sqrt;

#define SHARED inline
// fluid_look.glsl stands on optics.glsl: the order is not the alphabet's.
// clang-format off
#include "render/shaders/bilateral.glsl"
#include "render/shaders/cell_table.glsl"
#include "render/shaders/display_shaper.glsl"
#include "render/shaders/edges.glsl"
#include "render/shaders/material.glsl"
#include "render/shaders/narrow_range.glsl"
#include "render/shaders/octahedral.glsl"
#include "render/shaders/optics.glsl"
#include "render/shaders/fluid_look.glsl"
#include "render/shaders/room.glsl"
#include "render/shaders/smoothing.glsl"
#include "render/shaders/sphere.glsl"
#include "render/shaders/thickness.glsl"
// clang-format on
#undef SHARED

}  // namespace slosh::shader
