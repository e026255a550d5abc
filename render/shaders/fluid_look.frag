// The fluid as it looks beyond the paper: fluid_look.glsl for one pixel. Pixels without fluid are left as the scene drew them.
#include "fluid_data.glsl"
#include "fluid_normal.glsl"
#include "environment.glsl"
#include "shadow.glsl"
#include "look_block.glsl"
#include "fluid_look.glsl"
layout(binding = 4) uniform sampler2D scene_color;

// How much of the sky the fluid leaves open over this point, 0–1: taps on two rings over the smoothed depths.
float open_sky(vec3 here, vec3 n, ivec2 texel, int taps) {
  float reach = 6.0 * splat.x;
  float pixels = min(reach * splat.y / -here.z, 80.0);
  float hidden = 0.0;
  for (int i = 0; i < taps; ++i) {
    float angle = float(i) * 1.0471976;
    vec2 at = vec2(texel) + 0.5 + pixels * (0.45 + 0.45 * float(i & 1)) * vec2(cos(angle), sin(angle));
    float there = texelFetch(smooth_depth, clamp(ivec2(at), ivec2(0), ivec2(picture.xy) - 1), 0).r;
    vec3 to = eye_position(at, there) - here;
    float squared = dot(to, to);
    float near = max(1.0 - squared / (4.0 * reach * reach), 0.0);
    hidden += near * max(dot(to, n) * inversesqrt(squared + 1.0e-10) - 0.1, 0.0);
  }
  return clamp(1.0 - 0.35 * hidden, 0.25, 1.0);
}

// Share of what is seen behind that is mirrored by the fluid's floor, 0–1. Light that came in through a side meets the floor so
// flat that all of it is mirrored, where air or thin glass is under the floor and not a body that is wet. The far side of the
// fluid is a floor where it goes on level from pixel to pixel. inside: unit, of the light in the fluid, eye axes.
float mirrored_by_floor(vec3 inside, float refraction, float back, float scene, vec2 middle) {
  vec3 up = eye_from_world[1].xyz;
  float down = -dot(inside, up);
  float flat_enough = smoothstep(0.0, 0.06, (1.0 - down * down) * refraction * refraction - 1.0) * step(0.0, down);
  float apart = smoothstep(0.0, 0.25, (scene - back) / splat.x);
  float reach = clamp(2.5 * splat.x * splat.y / back, 2.0, 24.0);
  vec2 above = middle + vec2(0.0, reach);
  vec2 below = middle - vec2(0.0, reach);
  vec2 size = vec2(textureSize(back_depth, 0));
  float back_above = texelFetch(back_depth, ivec2(clamp(above * picture.zw, vec2(0.0), vec2(0.999)) * size), 0).r;
  float back_below = texelFetch(back_depth, ivec2(clamp(below * picture.zw, vec2(0.0), vec2(0.999)) * size), 0).r;
  back_above = back_above > 0.0 ? back_above : back;
  back_below = back_below > 0.0 ? back_below : back;
  vec3 along = eye_position(above, back_above) - eye_position(below, back_below);
  float level = 1.0 - smoothstep(0.55, 0.9, abs(dot(along, up)) * inversesqrt(dot(along, along) + 1.0e-12));
  return flat_enough * apart * level;
}

// The scene behind. A body in front of the fluid must not show through it; whole texels, as a mean would mix such a body in.
vec3 seen_behind(vec3 here, vec3 n, float refraction, float thickness, ivec2 texel) {
  float scene = min(texelFetch(scene_depth, texel, 0).r, camera.w);
  float behind = max(scene + here.z - thickness, 0.0);
  vec3 place = seen_place(here, normalize(here), n, refraction, thickness, behind);
  vec2 at = (place.xy / (unproject.xy * max(-place.z, 1.0e-3)) - unproject.zw) * 0.5 + 0.5;
  // No farther than a sixth of the picture's height: a normal that is off must not fetch the other end of the room.
  vec2 middle = vec2(texel) + 0.5;
  vec2 off = (at - middle * picture.zw) * picture.xy;
  off *= min(1.0, 0.16 * picture.y / max(length(off), 1.0e-3));
  ivec2 looked_up = clamp(ivec2(middle + off), ivec2(0), ivec2(picture.xy) - 1);
  if (texelFetch(scene_depth, looked_up, 0).r < -here.z) looked_up = texel;
  return texelFetch(scene_color, looked_up, 0).rgb;
}

// The same with what the fluid's floor mirrors: the room beyond the far side, through some more fluid.
vec3 seen_through_fluid(vec3 here, vec3 n, FluidMatter matter, float thickness, ivec2 texel) {
  vec3 seen = seen_behind(here, n, matter.refraction, thickness, texel);
  vec3 way = normalize(here);
  float scene = texelFetch(scene_depth, texel, 0).r;
  float back = back_depth_at(vec2(texel) + 0.5);
  float mirrored = mirrored_by_floor(refract(way, n, 1.0 / matter.refraction), matter.refraction, back, scene, vec2(texel) + 0.5);
  vec3 out_way = mat3(world_from_eye) * way * vec3(1.0, -1.0, 1.0);
  return mix(seen, studio(out_way) * transmittance(matter.extinction, thickness), mirrored);
}

bool pixel(ivec2 texel, out vec4 value) {
  float raw = texelFetch(front_depth, texel, 0).r;
  float front = texelFetch(smooth_depth, texel, 0).r;
  float thickness = thickness_at(texel, raw, front);
  if (thickness <= 0.0) return false;

  Look look = looks[floatBitsToUint(raw) & 15u];
  FluidMatter matter = FluidMatter(look.color_displacement.rgb, look.extinction_scattering.rgb, look.extinction_scattering.a,
                                   look.surface.x * switches.x, look.surface.y, look.surface.z);
  vec3 eye = eye_position(vec2(texel) + 0.5, front);
  FluidSurface surface = surface_of_pixel(smooth_depth, eye, texel);
  vec3 to_eye = normalize(-eye);
  FluidPoint point = FluidPoint(surface.normal, to_eye, to_light_eye.xyz, thickness);

  vec3 world_n = mat3(world_from_eye) * surface.normal;
  vec3 world = (world_from_eye * vec4(eye, 1.0)).xyz;
  vec3 light = vec3(light_past_meshes(world, world_n));
  if (switches.z > 0.5) light *= light_past_fluid_above(world, matter.extinction);
  // What scatters little is hardly lit: it needs no open sky.
  int taps = matter.scattering > 0.02 ? 6 : 0;
  vec3 mirror = mat3(world_from_eye) * reflect(-to_eye, surface.normal);
  FluidLight lit = FluidLight(key_light.rgb * light, ambient_light(world_n) * open_sky(eye, surface.normal, texel, taps),
                              rough_studio(mirror, matter.roughness),
                              seen_through_fluid(eye, surface.normal, matter, thickness, texel));
  value = vec4(fluid_radiance(matter, point, lit, surface.whole), 0.0);
  return true;
}
#include "pixel_main.glsl"
