// One iteration of the fast bilateral filter (5.1).
#include "frame_block.glsl"
#include "shared.glsl"
#include "bilateral.glsl"
layout(binding = 0) uniform sampler2D source;
uniform float spread;  // taps further out by this share of the splat's radius on screen; 0 = the paper's 5×5 pixels
layout(location = 0) out float depth;
void main() {
  float inner = texelFetch(source, ivec2(gl_FragCoord.xy), 0).r;
  // Odd strides keep the taps between texels, where one bilinear sample is a 2×2 mean.
  float stride = 2.0 * floor(0.5 * min(spread * splat.x * splat.y / inner, 31.0)) + 1.0;
  vec2 at = gl_FragCoord.xy * picture.zw;
  vec2 a = stride * bilateral_offset(0) * picture.zw;
  vec2 b = stride * bilateral_offset(1) * picture.zw;
  vec4 outer = vec4(texture(source, at + a).r, texture(source, at + b).r, texture(source, at - a).r,
                    texture(source, at - b).r);
  depth = inner > kFluidDepthLimit ? inner : bilateral_depth(inner, outer, splat.z);
}
