// One iteration of the fast bilateral filter (5.1).
#include "frame_block.glsl"
#include "shared.glsl"
#include "bilateral.glsl"
layout(binding = 0) uniform sampler2D source;
layout(location = 0) out float depth;
void main() {
  float inner = texelFetch(source, ivec2(gl_FragCoord.xy), 0).r;
  vec2 at = gl_FragCoord.xy * picture.zw;
  vec2 a = bilateral_offset(0) * picture.zw;
  vec2 b = bilateral_offset(1) * picture.zw;
  vec4 outer = vec4(texture(source, at + a).r, texture(source, at + b).r, texture(source, at - a).r,
                    texture(source, at - b).r);
  depth = inner > kFluidDepthLimit ? inner : bilateral_depth(inner, outer, splat.z);
}
