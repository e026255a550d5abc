// A glass: what lies behind (BEHIND) or in front of the fluid's surface, blended (premultiplied alpha).
#include "environment.glsl"
#include "shared.glsl"
#include "optics.glsl"
#include "bilateral.glsl"
layout(binding = 0) uniform sampler2D fluid_depth;
in vec3 world;
in vec3 world_normal;
in float eye_depth;
uniform vec4 base;
uniform vec2 roughness;
uniform int has_fluid;
layout(location = 0) out vec4 color;
void main() {
  float surface = has_fluid != 0 ? texelFetch(fluid_depth, ivec2(gl_FragCoord.xy), 0).r : 1.0e6;
#ifdef BEHIND
  if (eye_depth <= surface) discard;
#else
  if (eye_depth > surface) discard;
#endif
  vec3 to_eye = normalize(camera.xyz - world);
  vec3 n = normalize(world_normal);
  if (dot(n, to_eye) < 0.0) n = -n;
  // No shadow and no glint of its own: the mirrored softbox is the glint.
  vec3 key = key_light.rgb * (0.31830989 * max(dot(n, to_light_world.xyz), 0.0));
  float mirroring = schlick(0.04, dot(n, to_eye));
  float opacity = base.a + (1.0 - base.a) * mirroring;
  vec3 mirror = mirrored(reflect(-to_eye, n)) * (1.0 - roughness.y);
  color = vec4(base.rgb * (key + ambient_light(n)) * base.a + mirror * mirroring, opacity);
}
