// The fluid as it looks beyond the paper: fluid_look.glsl for one pixel. Pixels without fluid are left as the scene drew them.
#include "fluid_data.glsl"
#include "fluid_normal.glsl"
#include "environment.glsl"
#include "shadow.glsl"
#include "look_block.glsl"
#include "fluid_look.glsl"
layout(binding = 4) uniform sampler2D scene_color;
#if defined(BODIES) || defined(CAUSTICS)
#include "mirrored_bodies.glsl"
#endif
#ifdef CAUSTICS
#include "caustic_light.glsl"
#endif

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

// The fluid's far side where air or thin glass is behind it and not a body that is wet: what meets it so flat that all of it is
// mirrored there. Off its floor, for light that came in through a wall, the room beyond is seen; off its walls, which light meets
// flat from above and through another wall, what is under the fluid. Either comes a longer way through the fluid, as long as
// that of the pixels next to it: so a rim is as dark as the rest, as in a glass of honey. The far side is a floor where it
// goes on level from pixel to pixel, a wall where it is upright.
struct FarSide {
  float by_floor;  // shares mirrored, 0–1
  float by_wall;
};

float back_at(vec2 pixel) {
  vec2 size = vec2(textureSize(back_depth, 0));
  return texelFetch(back_depth, ivec2(clamp(pixel * picture.zw, vec2(0.0), vec2(0.999)) * size), 0).r;
}

// How much of the way from front to back is fluid, 0–1, over a patch of five places one reach apart: in a jet and in spray, where the
// far side is one drop's here and another's there, it is little; taken for a floor, they were flat patches of the room's colour.
// Of one place it flips from pixel to pixel at a floor's foot, where few particles are behind each other.
// taps: 5; 0 where it is not asked for, as llvmpipe goes through what is behind an if but leaves a loop.
float filled(vec2 middle, float reach, int taps) {
  if (look_switches.x <= 0.5) return 1.0;
  float chords = 0.0;
  float spans = 1.0e-6;
  for (int k = 0; k < taps; ++k) {
    vec2 at = middle + reach * (k == 0 ? vec2(0.0) : k < 3 ? vec2(2 * k - 3, 0) : vec2(0, 2 * k - 7));
    ivec2 texel = clamp(ivec2(at), ivec2(0), ivec2(picture.xy) - 1);
    // Up to a body in the fluid: no chord is counted behind it.
    float span = min(back_at(at), texelFetch(scene_depth, texel, 0).r) - texelFetch(smooth_depth, texel, 0).r;
    spans += max(span, 0.0);
    chords += clamp(texture(summed_chord, at * picture.zw).r, 0.0, max(span, 0.0));
  }
  return chords / spans;
}

// inside: unit, of the light in the fluid, eye axes. back: of this pixel.
FarSide far_side(vec3 inside, float refraction, float back, float scene, vec2 middle) {
  vec3 up = eye_from_world[1].xyz;
  float down = -dot(inside, up);
  float flat_enough = smoothstep(0.0, 0.06, (1.0 - down * down) * refraction * refraction - 1.0) * step(0.0, down);
  float apart = (scene - back) / splat.x;
  vec2 reach = vec2(0.0, clamp(2.5 * splat.x * splat.y / back, 2.0, 24.0));
  // Over three columns: by one alone every ball at the far side's foot had a tooth of its own in the line where the floor begins.
  float above = 0.0;
  float below = 0.0;
  for (int k = -1; k <= 1; ++k) {
    vec2 column = middle + vec2(0.6 * float(k) * reach.y, 0.0);
    float a = back_at(column + reach);
    float b = back_at(column - reach);
    above += a > 0.0 ? a : back;
    below += b > 0.0 ? b : back;
  }
  vec3 along = eye_position(middle + reach, above / 3.0) - eye_position(middle - reach, below / 3.0);
  float upright = smoothstep(0.55, 0.9, abs(dot(along, up)) * inversesqrt(dot(along, along) + 1.0e-12));
  // Along a line of sight that grazes a wet wall there is some way from the splats to it.
  float by_floor = flat_enough * smoothstep(0.0, 0.25, apart) * (1.0 - upright);
  by_floor *= smoothstep(0.4, 0.9, filled(middle, reach.y, by_floor > 0.0 ? 5 : 0));
  return FarSide(by_floor, smoothstep(1.5, 3.0, apart) * upright);
}

// How much farther light comes that the far side mirrored, m: half the longest way through the fluid of four pixels eight splats away.
float way_beside(vec2 middle, float back, int taps) {
  float reach = clamp(8.0 * splat.x * splat.y / back, 4.0, 96.0);
  float way = 0.0;
  for (int k = 0; k < taps; ++k) {
    vec2 at = middle + reach * vec2(k < 2 ? 2 * k - 1 : 0, k < 2 ? 0 : 2 * k - 5);
    float front = texelFetch(smooth_depth, clamp(ivec2(at), ivec2(0), ivec2(picture.xy) - 1), 0).r;
    float span = max(back_at(at) - front, 0.0);
    // Of spray it is its few drops that count, not the air between them.
    way = max(way, look_switches.x > 0.5 ? min(span, texture(summed_chord, at * picture.zw).r) : span);
  }
  return 0.5 * way;
}

// What of the scene behind is seen. A body in front of the fluid must not show through it; whole texels, as a mean would mix such a
// body in. There may be a body in the fluid here, and beside it, what lies behind: with the body's short way that was a pale rim at its
// foot.
struct Behind {
  ivec2 texel;
  float farther;  // than at the pixel itself the fluid goes on, m
};

Behind behind_here(vec3 here, vec3 n, float refraction, float thickness, float own_scene, float back, ivec2 texel) {
  float scene = min(own_scene, camera.w);
  float behind = max(scene + here.z - thickness, 0.0);
  vec3 place = seen_place(here, normalize(here), n, refraction, thickness, behind);
  vec2 at = (place.xy / (unproject.xy * max(-place.z, 1.0e-3)) - unproject.zw) * 0.5 + 0.5;
  // No farther than a sixth of the picture's height: a normal that is off must not fetch the other end of the room.
  vec2 middle = vec2(texel) + 0.5;
  vec2 off = (at - middle * picture.zw) * picture.xy;
  off *= min(1.0, 0.16 * picture.y / max(length(off), 1.0e-3));
  ivec2 looked_up = clamp(ivec2(middle + off), ivec2(0), ivec2(picture.xy) - 1);
  float there = texelFetch(scene_depth, looked_up, 0).r;
  if (there < -here.z) return Behind(texel, 0.0);
  float farther = min(there, back_at(vec2(looked_up) + 0.5)) - min(scene, back);
  return Behind(looked_up, there - scene > splat.x ? max(farther, 0.0) : 0.0);
}

vec3 seen_behind(ivec2 looked_up) {
#ifdef CAUSTICS
  return texelFetch(scene_color, looked_up, 0).rgb * caustic_light(vec2(looked_up) + 0.5);
#else
  return texelFetch(scene_color, looked_up, 0).rgb;
#endif
}

// Water in the air is a lens: a stream, a sheet, a drop. It shows the room upside down, with dark and bright lines where light comes
// from far off the line of sight; as a slab, which shows what is behind it nearly as it is, it could hardly be seen. share: 0 where
// the far side is a body's or the way is so long that the far side as it is known says little.
struct Lens {
  float share;
  vec3 light;
};

// m of fluid on the line of sight of a place in the picture; 0 where there is none. By summed chords, which are soft as befits many
// particles; of a drop by its own two sides. `many`: 0–1.
float way_at(vec2 at, float many) {
  float front = texelFetch(smooth_depth, clamp(ivec2(at), ivec2(0), ivec2(picture.xy) - 1), 0).r;
  float span = front > kFluidDepthLimit ? 0.0 : max(back_at(at) - front, 0.0);
  float chords = texture(summed_chord, at * picture.zw).r;
  return mix(layered_thickness(span, chords), chords, many);
}

Lens lens_here(vec3 here, vec3 n, vec3 inside, float refraction, float thickness, float scene, float back, vec2 middle) {
  Lens lens = Lens(0.0, vec3(0.0));
  if (look_switches.x <= 0.5) return lens;
  lens.share = smoothstep(0.5, 2.0, (scene - back) / splat.x) * (1.0 - smoothstep(6.0, 9.0, thickness / splat.x));
  // Nor at the edge of much fluid: the way through it a little further in.
  float beside = clamp(7.0 * splat.x * splat.y / -here.z, 4.0, 96.0);
  float most = 0.0;
  if (lens.share <= 0.0) return lens;
  int taps = lens.share > 0.0 ? 8 : 0;  // as in filled()
  for (int k = 0; k < taps; ++k) {
    float angle = 0.7853982 * float(k);
    vec2 at = middle + ((k & 1) == 0 ? beside : 0.5 * beside) * vec2(cos(angle), sin(angle));
    most = max(most, texture(summed_chord, at * picture.zw).r);
  }
  lens.share *= 1.0 - smoothstep(4.5, 7.0, most / splat.x);
  float reach = clamp(0.5 * splat.x * splat.y / -here.z, 2.0, 16.0);
  float many = smoothstep(1.8, 3.0, thickness / splat.x);
  vec2 growth = vec2(0.0);
  if (lens.share <= 0.0) return lens;
  int axes = lens.share > 0.0 ? 2 : 0;
  for (int axis = 0; axis < axes; ++axis) {
    vec2 off = axis == 0 ? vec2(reach, 0.0) : vec2(0.0, reach);
    growth[axis] = way_at(middle + off, many) - way_at(middle - off, many);
  }
  growth *= splat.y / (2.0 * reach * -here.z);
  vec3 way = leaving_way(inside, far_normal(n, growth), refraction);
  vec3 out_at = leaving_place(here, inside, thickness);
  lens.light = mirrored(mat3(world_from_eye) * way);
  // A body that the picture shows, where the way leads to one: guessed at the depth of what is behind, then at that of what is there.
  int guesses = lens.share > 0.0 && way.z <= -0.1 ? 2 : 0;
  float depth = min(scene, camera.w);
  for (int guess = 0; guess < guesses; ++guess) {
    vec3 place = out_at + way * (max(depth + out_at.z, 0.0) / -way.z);
    vec2 at = ((place.xy / (unproject.xy * max(-place.z, 1.0e-3)) - unproject.zw) * 0.5 + 0.5) * picture.xy;
    if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, picture.xy))) return lens;
    depth = texelFetch(scene_depth, ivec2(at), 0).r;
    if (depth > camera.w) return lens;
    if (guess == 1 && depth > -here.z) lens.light = texelFetch(scene_color, ivec2(at), 0).rgb;
  }
  return lens;
}

FluidMatter matter_of_look(uint index) {
  Look look = looks[index];
  return FluidMatter(look.color_displacement.rgb, look.extinction_scattering.rgb, look.extinction_scattering.a,
                     look.surface.x * switches.x, look.surface.y, look.surface.z);
}

#ifdef MIXED
// Where fluids meet: by their shares in the surface here (mixing.glsl), between the four texels round the pixel whose surface is
// this one. What has none there is the front-most particle's alone.
layout(binding = 12) uniform sampler2D shares[MIXED];  // of four fluids each
uniform int share_pixels;                              // of the picture along one of their texels
FluidMatter matter_here(uint own, ivec2 texel, float front) {
  ivec2 last = textureSize(shares[0], 0) - 1;
  vec2 at = (vec2(texel) + 0.5) / float(share_pixels) - 0.5;
  vec2 low = floor(at);
  vec2 off = at - low;
  vec4 sum[MIXED];
  for (int i = 0; i < MIXED; ++i) sum[i] = vec4(0.0);
  for (int k = 0; k < 4; ++k) {
    ivec2 corner = clamp(ivec2(low) + ivec2(k & 1, k >> 1), ivec2(0), last);
    float there = texelFetch(smooth_depth, min(corner * share_pixels + share_pixels / 2, ivec2(picture.xy) - 1), 0).r;
    float weight = ((k & 1) == 1 ? off.x : 1.0 - off.x) * ((k >> 1) == 1 ? off.y : 1.0 - off.y);
    weight *= max(1.0 - abs(there - front) * splat.z, 0.0);
    for (int i = 0; i < MIXED; ++i) sum[i] += weight * texelFetch(shares[i], corner, 0);
  }
  FluidMixture mixture = add_to_mixture(no_mixture(), matter_of_look(own), 1.0e-3);
  for (int i = 0; i < MIXED; ++i) {
    for (int k = 0; k < 4; ++k) mixture = add_to_mixture(mixture, matter_of_look(uint(4 * i + k)), sum[i][k]);
  }
  return matter_of(mixture);
}
#else
FluidMatter matter_here(uint own, ivec2 texel, float front) { return matter_of_look(own); }
#endif

bool pixel(ivec2 texel, out vec4 value) {
  float raw = texelFetch(front_depth, texel, 0).r;
  float front = texelFetch(smooth_depth, texel, 0).r;
  float thickness = thickness_at(texel, raw, front);
  if (thickness <= 0.0) return false;

  FluidMatter matter = matter_here(floatBitsToUint(raw) & 15u, texel, front);
  vec3 eye = eye_position(vec2(texel) + 0.5, front);
  FluidSurface surface = fluid_surface(smooth_depth, eye, texel);
  vec3 to_eye = normalize(-eye);
  float scene = texelFetch(scene_depth, texel, 0).r;
  vec3 inside = refract(-to_eye, surface.normal, 1.0 / matter.refraction);
  vec2 middle = vec2(texel) + 0.5;
  float back = back_depth_at(middle);
  FarSide far = far_side(inside, matter.refraction, back, scene, middle);
  float mirrored = far.by_floor + far.by_wall;
  float way = thickness + mirrored * way_beside(middle, back, mirrored > 0.0 ? 4 : 0);
  Behind behind = behind_here(eye, surface.normal, matter.refraction, thickness, scene, back, texel);
  way += behind.farther;
  FluidPoint point = FluidPoint(surface.normal, to_eye, to_light_eye.xyz, way);

  vec3 world_n = mat3(world_from_eye) * surface.normal;
  vec3 world = (world_from_eye * vec4(eye, 1.0)).xyz;
  vec3 light = vec3(light_past_meshes(world, world_n));
  if (switches.z > 0.5) light *= light_past_fluid_above(world, matter.extinction);
  // What scatters little is hardly lit: it needs no open sky.
  int taps = matter.scattering > 0.02 ? 6 : 0;
  vec3 mirror = mat3(world_from_eye) * reflect(-to_eye, surface.normal);
  vec3 mirrored_light = rough_studio(mirror, matter.roughness);
#ifdef BODIES
  // A rough surface mirrors a blur of them, which one ray does not find.
  vec4 body = mirrored_body(eye, reflect(-to_eye, surface.normal));
  mirrored_light = mix(mirrored_light, body.rgb, body.a * (1.0 - smoothstep(0.15, 0.45, matter.roughness)));
#endif
  vec3 seen = seen_behind(behind.texel);
  seen = mix(seen, studio(mat3(world_from_eye) * -to_eye * vec3(1.0, -1.0, 1.0)), far.by_floor);
  Lens lens = lens_here(eye, surface.normal, inside, matter.refraction, thickness, scene, back, middle);
  FluidLight lit = FluidLight(key_light.rgb * light, ambient_light(world_n) * open_sky(eye, surface.normal, texel, taps),
                              mirrored_light, mix(seen, lens.light, lens.share));
  // Against air a rim is the fluid's own.
  value = vec4(fluid_radiance(matter, point, lit, max(surface.whole, lens.share)), 0.0);
  return true;
}
#include "pixel_main.glsl"
