// S_c without what is before it (resolve.glsl).
#include "resolve.glsl"
layout(binding = 0) uniform sampler2D mesh_color;
layout(binding = 1) uniform sampler2D occlusion;
bool pixel(ivec2 texel, out vec4 value) {
  value = resolved(mesh_color, occlusion, texel);
  return true;
}
#include "pixel_main.glsl"
