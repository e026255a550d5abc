// Share of the light that reaches a world point past the meshes, by percentage-closer filtering.
#include "frame_block.glsl"

layout(binding = 8) uniform sampler2DShadow shadow_map;
layout(binding = 9) uniform sampler2D fluid_shadow;  // thickness of fluid towards the light, m; light depth of its top

float light_reaching(vec3 world, vec3 normal) {
  if (to_light_world.w < 0.5) return 1.0;
  float texel = to_light_eye.w;
  vec4 at = shadow_from_world * vec4(world, 1.0);
  if (any(greaterThan(abs(at.xyz - 0.5), vec3(0.5)))) return 1.0;
#ifdef FAST
  return texture(shadow_map, at.xyz);
#else
  // Four bilinear taps, turned so that their footprints do not line up with the texels.
  float sum = texture(shadow_map, vec3(at.xy + texel * vec2(0.55, 1.3), at.z));
  sum += texture(shadow_map, vec3(at.xy + texel * vec2(-1.3, 0.55), at.z));
  sum += texture(shadow_map, vec3(at.xy + texel * vec2(-0.55, -1.3), at.z));
  sum += texture(shadow_map, vec3(at.xy + texel * vec2(1.3, -0.55), at.z));
  return 0.25 * sum;
#endif
}
