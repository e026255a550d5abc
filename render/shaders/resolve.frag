// S_c without what is before it: the meshes' colour with the occlusion's share of their ambient light taken away.
#include "frame_block.glsl"
layout(binding = 0) uniform sampler2D mesh_color;
layout(binding = 1) uniform sampler2D occlusion;
bool pixel(ivec2 texel, out vec4 value) {
  vec4 lit = texelFetch(mesh_color, texel, 0);
  // Four bilinear taps cover the 4×4 pattern of occlusion.frag.
  vec2 at = (vec2(texel) + 0.5) * picture.zw;
  vec2 step_by = 2.0 * picture.zw;
  float open = 0.25 * (texture(occlusion, at + step_by * vec2(1.0, 1.0)).r + texture(occlusion, at + step_by * vec2(-1.0, 1.0)).r +
                       texture(occlusion, at + step_by * vec2(1.0, -1.0)).r + texture(occlusion, at + step_by * vec2(-1.0, -1.0)).r);
  value = vec4(lit.rgb * (1.0 - lit.a * (1.0 - open)), 0.0);
  return true;
}
#include "pixel_main.glsl"
