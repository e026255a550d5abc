// Eq 15. Pixels without fluid are left as the scene drew them.
#include "fluid_data.glsl"
#include "fluid_normal.glsl"
#include "environment.glsl"
#include "shadow.glsl"
layout(binding = 4) uniform sampler2D scene_color;

struct Look {
  vec4 color_refraction;   // F_c, β
  vec4 extinction;         // F_e, 1/m
  vec4 specular_exponent;  // k_s, α
};
layout(std140, binding = 1) uniform Looks { Look looks[16]; };

layout(location = 0) out vec4 color;

// How much of the sky the fluid leaves open over this point, 0–1: six taps on two rings over the smoothed depths.
float open_sky(vec3 here, vec3 n, ivec2 texel) {
  float reach = 6.0 * splat.x;
  float pixels = min(reach * splat.y / -here.z, 80.0);
  float hidden = 0.0;
  for (int i = 0; i < 6; ++i) {
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

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float raw = texelFetch(front_depth, texel, 0).r;
  float front = texelFetch(smooth_depth, texel, 0).r;
  float thickness = thickness_at(texel, raw, front);
  if (thickness <= 0.0) discard;

  Look look = looks[floatBitsToUint(raw) & 15u];
  vec3 eye = eye_position(gl_FragCoord.xy, front);
  FluidSurface surface = surface_of_pixel(smooth_depth, eye, texel);
  vec3 n = surface.normal;
  vec3 to_eye = normalize(-eye);

  // A body in front of the fluid must not show through it. Whole texels, as a mean would mix such a body in.
  vec2 here = gl_FragCoord.xy * picture.zw;
  vec2 there = here + refraction_offset(n, look.color_refraction.a, thickness, picture.x * picture.w);
  ivec2 looked_up = clamp(ivec2(there * picture.xy), ivec2(0), ivec2(picture.xy) - 1);
  if (texelFetch(scene_depth, looked_up, 0).r < front) looked_up = texel;
  vec3 behind = texelFetch(scene_color, looked_up, 0).rgb;

  vec3 world_n = mat3(world_from_eye) * n;
  vec3 light = vec3(1.0);
  vec3 fluid_color = look.color_refraction.rgb;
  if (switches.y > 0.5) {
    vec3 world = (world_from_eye * vec4(eye, 1.0)).xyz;
    light *= light_past_meshes(world, world_n);
    if (switches.z > 0.5) light *= light_past_fluid_above(world, look.extinction.rgb);
    // Light wanders in the fluid and comes out beyond the edge of its lit side; what it gains there it lacks elsewhere.
    float wrapped = max(dot(n, to_light_eye.xyz) + 0.3, 0.0) / (1.3 * 1.3);
    fluid_color *= key_light.rgb * light * (0.31830989 * wrapped) + ambient_light(world_n) * open_sky(eye, n, texel);
  }
  vec3 seen = seen_through(fluid_color, behind, look.extinction.rgb, thickness);
  if (switches.x > 0.5) {
    vec3 mirror = studio(mat3(world_from_eye) * reflect(-to_eye, n));
    seen = mix(seen, mirror, schlick(0.02, max(dot(n, to_eye), 0.1)) * surface.whole);
  }
  float glint = blinn(n, to_light_eye.xyz, to_eye, look.specular_exponent.a) * surface.whole;
  color = vec4(seen + look.specular_exponent.rgb * glint * light, 0.0);
}
