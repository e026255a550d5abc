// A surface's normal from its depths.
#include "frame_block.glsl"

// From `here` to the next texel's surface: the smaller of the two one-sided differences, at an edge the one that stays on
// the surface. A neighbour deeper than `limit` is no surface.
vec3 depth_difference(sampler2D depths, vec3 here, ivec2 texel, ivec2 step_to, float limit) {
  ivec2 last = ivec2(picture.xy) - 1;
  bool has_ahead = all(lessThanEqual(texel + step_to, last));
  bool has_behind = all(greaterThanEqual(texel - step_to, ivec2(0)));
  float ahead = texelFetch(depths, min(texel + step_to, last), 0).r;
  float behind = texelFetch(depths, max(texel - step_to, ivec2(0)), 0).r;
  bool take_ahead = !has_behind || (has_ahead && abs(ahead + here.z) < abs(behind + here.z));
  float d = take_ahead ? ahead : behind;
  if (d > limit) d = -here.z;  // a lone pixel faces the eye
  vec3 there = eye_position(vec2(texel) + 0.5 + vec2(take_ahead ? step_to : -step_to), d);
  return take_ahead ? there - here : here - there;
}

// Unit, eye axes.
vec3 depth_normal(sampler2D depths, vec3 here, ivec2 texel, float limit) {
  return normalize(cross(depth_difference(depths, here, texel, ivec2(1, 0), limit),
                         depth_difference(depths, here, texel, ivec2(0, 1), limit)));
}
