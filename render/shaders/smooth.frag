// One iteration of the fast bilateral filter (5.1).
#include "frame_block.glsl"
#include "shared.glsl"
#include "bilateral.glsl"
layout(binding = 0) uniform sampler2D source;
bool pixel(ivec2 texel, out vec4 value) {
  float inner = texelFetch(source, texel, 0).r;
  vec2 at = (vec2(texel) + 0.5) * picture.zw;
  vec2 a = bilateral_offset(0) * picture.zw;
  vec2 b = bilateral_offset(1) * picture.zw;
  vec4 outer = vec4(texture(source, at + a).r, texture(source, at + b).r, texture(source, at - a).r,
                    texture(source, at - b).r);
  value = vec4(inner > kFluidDepthLimit ? inner : bilateral_depth(inner, outer, splat.z));
  return true;
}
#include "pixel_main.glsl"
