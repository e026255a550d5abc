// Fluid data of a pixel: what compositing and the tests' buffers read.
#include "frame_block.glsl"
#include "shared.glsl"
#include "optics.glsl"
#include "bilateral.glsl"
#include "thickness.glsl"
layout(binding = 0) uniform sampler2D front_depth;   // with the fluid's index in its low bits
layout(binding = 1) uniform sampler2D smooth_depth;
layout(binding = 2) uniform sampler2D back_depth;    // 0 where there is none
layout(binding = 3) uniform sampler2D scene_depth;
layout(binding = 5) uniform sampler2D summed_chord;  // of all particles before the scene, m; where section 5 does not stand as it is

// Bilinear, over those of the four texels that are fluid.
float back_depth_at(vec2 pixel) {
  vec2 size = vec2(textureSize(back_depth, 0));
  vec2 at = pixel * picture.zw;
  vec4 four = textureGather(back_depth, at);
  vec2 f = fract(at * size - 0.5);
  vec4 w = vec4((1.0 - f.x) * f.y, f.x * f.y, f.x * (1.0 - f.y), (1.0 - f.x) * (1.0 - f.y));
  w *= vec4(greaterThan(four, vec4(0.0)));
  return dot(w, four) / max(dot(w, vec4(1.0)), 1.0e-6);
}

// T of Eq 15; 0 where there is no fluid. raw, front: front depth as splatted, and smoothed.
float thickness_at(ivec2 texel, float raw, float front) {
  if (raw > kFluidDepthLimit) return 0.0;
  float scene = texelFetch(scene_depth, texel, 0).r;
  float back = back_depth_at(vec2(texel) + 0.5);
  if (switches.w > 0.5) return fluid_thickness(front, back, scene);
  float span = kept_thickness(front, raw, back, scene, splat.x);
  return look_switches.x > 0.5 ? layered_thickness(span, texture(summed_chord, (vec2(texel) + 0.5) * picture.zw).r) : span;
}
