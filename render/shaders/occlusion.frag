// Ambient occlusion at half size, from S_d alone.
#include "depth_normal.glsl"
layout(binding = 0) uniform sampler2D scene_depth;
uniform float reach;  // m

bool pixel(ivec2 half_texel, out vec4 value) {
  ivec2 texel = min(half_texel * 2, ivec2(picture.xy) - 1);
  float d = texelFetch(scene_depth, texel, 0).r;
  value = vec4(1.0);
  if (d > camera.w) return true;
  vec3 here = eye_position(vec2(texel) + 0.5, d);
  vec3 n = depth_normal(scene_depth, here, texel, camera.w);
  float pixels = min(reach * splat.y / d, 120.0);
  // A spiral turned by a 4×4 pattern, which the 4×4 blur of the resolve takes away again.
  ivec2 cell = half_texel & 3;
  float turn = float((cell.x * 4 + cell.y * 7 + (cell.x ^ cell.y) * 5) & 15) * (6.2831853 / 16.0);
  float hidden = 0.0;
  for (int i = 0; i < TAPS; ++i) {
    float share = (float(i) + 0.5) / float(TAPS);
    float angle = turn + float(i) * 2.3999632;
    vec2 at = vec2(texel) + 0.5 + pixels * sqrt(share) * vec2(cos(angle), sin(angle));
    float there = texelFetch(scene_depth, clamp(ivec2(at), ivec2(0), ivec2(picture.xy) - 1), 0).r;
    vec3 to = eye_position(at, there) - here;
    float squared = dot(to, to);
    float lift = max(dot(to, n) - 0.002 * d, 0.0);
    float near = max(1.0 - squared / (reach * reach), 0.0);
    hidden += near * lift * inversesqrt(squared + 1.0e-8);
  }
  value = vec4(clamp(1.0 - 2.2 * hidden / float(TAPS), 0.0, 1.0));
  return true;
}
#include "pixel_main.glsl"
