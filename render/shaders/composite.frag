// Eq 15. Pixels without fluid are left as the scene drew them.
#include "fluid_data.glsl"
#include "depth_normal.glsl"
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

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float front = texelFetch(smooth_depth, texel, 0).r;
  float thickness = thickness_at(texel, front);
  if (thickness <= 0.0) discard;

  Look look = looks[floatBitsToUint(texelFetch(front_depth, texel, 0).r) & 15u];
  vec3 eye = eye_position(gl_FragCoord.xy, front);
  vec3 n = depth_normal(smooth_depth, eye, texel, kFluidDepthLimit);
  vec3 to_eye = normalize(-eye);

  // A body in front of the fluid must not show through it. Whole texels, as a mean would mix such a body in.
  vec2 here = gl_FragCoord.xy * picture.zw;
  vec2 there = here + refraction_offset(n, look.color_refraction.a, thickness, picture.x * picture.w);
  ivec2 looked_up = clamp(ivec2(there * picture.xy), ivec2(0), ivec2(picture.xy) - 1);
  if (texelFetch(scene_depth, looked_up, 0).r < front) looked_up = texel;
  vec3 behind = texelFetch(scene_color, looked_up, 0).rgb;

  vec3 world_n = mat3(world_from_eye) * n;
  float light = 1.0;
  vec3 fluid_color = look.color_refraction.rgb;
  if (switches.y > 0.5) {
    vec3 world = (world_from_eye * vec4(eye, 1.0)).xyz;
    light = light_past_meshes(world, world_n);
    float wrapped = max((dot(n, to_light_eye.xyz) + 0.3) / 1.3, 0.0);
    fluid_color *= key_light.rgb * (0.31830989 * wrapped * light) + ambient_light(world_n);
  }
  vec3 seen = seen_through(fluid_color, behind, look.extinction.rgb, thickness);
  if (switches.x > 0.5) {
    // What a surface reflects from below the horizon is more fluid, or its vessel: never darker than the horizon here,
    // or the few normals that are wrong at an outline would stand out.
    vec3 way = mat3(world_from_eye) * reflect(-to_eye, n);
    vec3 mirror = studio(vec3(way.x, max(way.y, 0.0), way.z));
    seen = mix(seen, mirror, schlick(0.02, max(dot(n, to_eye), 0.1)));
  }
  float glint = blinn(n, to_light_eye.xyz, to_eye, look.specular_exponent.a) * light;
  color = vec4(seen + look.specular_exponent.rgb * glint, 0.0);
}
