// Share of the light that reaches a world point past the meshes: percentage-closer soft shadows (Fernando 2005), wider the farther what
// casts them is, by few taps where nothing is far.
#include "frame_block.glsl"

layout(binding = 7) uniform sampler2D shadow_reach;  // nearest, farthest depth about a tile (shadow_reach.frag)
layout(binding = 8) uniform sampler2DShadow shadow_map;
layout(binding = 9) uniform sampler2D fluid_shadow;  // dimming per channel; 1 − depth of the fluid's top (fluid_shadow.frag)

const float kLightWide = 0.08;  // tangent of half the angle that the light has for shadows
#ifdef FAST
const int kSoftTaps = 12;
const float kTapsATexel = 1.2;
const int kSharpTaps = 2;
const float kSharpWide = 1.0606602;  // texels
const vec2 kSharpWay = vec2(0.70710678, 0.70710678);
const vec2 kSharpTurn = vec2(-1.0, 0.0);
#else
const int kSoftTaps = 32;
const float kTapsATexel = 4.0;
const int kSharpTaps = 4;
const float kSharpWide = 1.4115594;
const vec2 kSharpWay = vec2(0.38964, 0.92097);
const vec2 kSharpTurn = vec2(0.0, 1.0);
#endif

vec3 in_shadow_map(vec3 world) { return (shadow_from_world * vec4(world, 1.0)).xyz; }

// By a surface's own slope depths differ from texel to texel; of the map's depth over its texture coordinates.
vec2 slope_in_shadow_map(vec3 normal) {
  vec3 turned = mat3(shadow_from_world) * normal;
  float across = 2.0 * to_light_eye.w / key_light.w;  // of the map, 1/m
  float away = 1.0 / look_switches.y;
  vec2 slope = -turned.xy * (away * away) / (across * across * min(turned.z, -0.1 * away));
  return turned.z < 0.0 ? slope : vec2(0.0);
}

// normal: unit, world. The look-up moves off the surface, so that a surface does not shade itself.
float light_past_meshes(vec3 world, vec3 normal) {
  vec3 at = in_shadow_map(world + normal * key_light.w);
  float texel = to_light_eye.w;
  vec2 tile = at.xy / (8.0 * texel);
  vec2 ends = texelFetch(shadow_reach, ivec2(clamp(tile, vec2(0.0), vec2(textureSize(shadow_reach, 0) - 1))), 0).rg;
  bool outside = to_light_world.w < 0.5 || any(greaterThan(abs(at - 0.5), vec3(0.5)));
  if (outside || ends.x >= at.z) return 1.0;
  float facing = clamp(dot(normal, to_light_world.xyz), 0.1, 1.0);
  // What a plane through the point has in so many texels; nearer than that a soft edge is as wide as a texel.
  float own = 0.5 * (look_switches.z + 8.0) * key_light.w * sqrt(1.0 - facing * facing) / (facing * look_switches.y);
  float nearest = texture(shadow_reach, tile / vec2(textureSize(shadow_reach, 0))).r;
  bool soft = ends.x < at.z - own;
  float wide = 2.0 * kLightWide * max(at.z - nearest, 0.0) * look_switches.y / key_light.w;
  wide = soft ? clamp(wide, 1.0, look_switches.z) : kSharpWide;
  vec2 slope = soft ? slope_in_shadow_map(normal) : vec2(0.0);
  bool dark = ends.y < at.z - own;
  // llvmpipe goes through both sides of an if, but leaves a loop: so one loop has all taps. Soft ones lie on a spiral by the golden angle,
  // each for as much area; sharp ones on a circle, turned so that their footprints do not line up with the texels.
  int taps = dark ? 0 : soft ? clamp(int(kTapsATexel * wide), 4, kSoftTaps) : kSharpTaps;
  vec2 turn = soft ? vec2(-0.73736888, 0.67549029) : kSharpTurn;
  vec2 way = kSharpWay;
  float reaching = 0.0;
  for (int k = 0; k < taps; ++k) {
    vec2 off = wide * texel * (soft ? sqrt((float(k) + 0.5) / float(taps)) : 1.0) * way;
    reaching += texture(shadow_map, vec3(at.xy + off, at.z + dot(slope, off)));
    way = vec2(turn.x * way.x - turn.y * way.y, turn.y * way.x + turn.x * way.y);
  }
  return dark ? 0.0 : reaching / float(taps);
}

// What fluid above leaves of the light for a point on the fluid's own surface. It fades in from three to nine splat radii
// below the fluid's top, so that neighbours do not dim each other; never more than the whole way through. Each of the four texels about
// the point says by itself whether it is below: between a drop's top and the surface there is nothing, and halfway down from one to the
// other a shadow had polygons for edges. Beyond the paper.
vec3 light_past_fluid_above(vec3 world, vec3 extinction) {
  vec3 at = in_shadow_map(world);
  vec2 texel = at.xy * vec2(textureSize(fluid_shadow, 0)) - 0.5;
  ivec2 low = ivec2(floor(texel));
  vec2 share = texel - vec2(low);
  ivec2 last = textureSize(fluid_shadow, 0) - 1;
  vec4 dimming[4];
  for (int k = 0; k < 4; ++k) dimming[k] = texelFetch(fluid_shadow, clamp(low + ivec2(k & 1, k >> 1), ivec2(0), last), 0);
  vec4 weights = vec4(1.0 - share.x, share.x, 1.0 - share.x, share.x) * vec4(1.0 - share.yy, share.yy);
  vec4 radii = (at.z - 1.0 + vec4(dimming[0].a, dimming[1].a, dimming[2].a, dimming[3].a)) * splat.w;
  vec4 below = smoothstep(3.0, 9.0, radii) * weights;
  float shaded = dot(below, vec4(1.0));
  float way = dot(below, radii) / max(shaded, 1.0e-6) * splat.x;
  vec3 through = vec3(0.0);
  for (int k = 0; k < 4; ++k) through += weights[k] * dimming[k].rgb;
  vec3 left = exp(-min(through, extinction * way));
  return to_light_world.w < 0.5 ? vec3(1.0) : mix(vec3(1.0), left, shaded);
}

// The same for what is below the fluid, per channel: exp of what the light passes through. The whole of it counts for a point anywhere
// below the fluid's top, so a point in the middle of the fluid is a little too dark. Beyond the paper.
vec3 light_past_fluid(vec3 world) {
  vec3 at = in_shadow_map(world);
  vec4 dimming = texture(fluid_shadow, at.xy);
  float below = clamp((at.z - (1.0 - dimming.a)) * splat.w, 0.0, 1.0);
  return to_light_world.w < 0.5 ? vec3(1.0) : exp(-dimming.rgb * below);
}
