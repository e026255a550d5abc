// Eq 15 as it stands. Pixels without fluid are left as the scene drew them.
#include "fluid_data.glsl"
#include "fluid_normal.glsl"
#include "environment.glsl"
#include "look_block.glsl"
layout(binding = 4) uniform sampler2D scene_color;

bool pixel(ivec2 texel, out vec4 value) {
  vec2 middle = vec2(texel) + 0.5;
  float raw = texelFetch(front_depth, texel, 0).r;
  float front = texelFetch(smooth_depth, texel, 0).r;
  float thickness = thickness_at(texel, raw, front);
  if (thickness <= 0.0) return false;

  Look look = looks[floatBitsToUint(raw) & 15u];
  vec3 eye = eye_position(middle, front);
  FluidSurface surface = surface_of_pixel(smooth_depth, eye, texel);
  vec3 n = surface.normal;
  vec3 to_eye = normalize(-eye);

  // A body in front of the fluid must not show through it. Whole texels, as a mean would mix such a body in.
  vec2 here = middle * picture.zw;
  vec2 there = here + refraction_offset(n, look.color_displacement.a, thickness, picture.x * picture.w);
  ivec2 looked_up = clamp(ivec2(there * picture.xy), ivec2(0), ivec2(picture.xy) - 1);
  if (texelFetch(scene_depth, looked_up, 0).r < front) looked_up = texel;
  vec3 behind = texelFetch(scene_color, looked_up, 0).rgb;

  vec3 seen = seen_through(look.color_displacement.rgb, behind, look.extinction_scattering.rgb, thickness);
  if (switches.x > 0.5) {
    vec3 mirror = studio(mat3(world_from_eye) * reflect(-to_eye, n));
    seen = mix(seen, mirror, schlick(0.02, max(dot(n, to_eye), 0.1)) * surface.whole);
  }
  float glint = blinn(n, to_light_eye.xyz, to_eye, look.specular_exponent.a) * surface.whole;
  value = vec4(seen + look.specular_exponent.rgb * glint, 0.0);
  return true;
}
#include "pixel_main.glsl"
