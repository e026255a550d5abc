// A glass: what lies behind (BEHIND) or in front of the fluid's surface. A thin pane: it mirrors on both faces and lets
// the rest through, tinted; only a rough one scatters light of its own. Two outputs of one blend: light added, and the
// share of what is behind that stays, per channel.
#include "environment.glsl"
#include "shared.glsl"
#include "optics.glsl"
#include "bilateral.glsl"
layout(binding = 0) uniform sampler2D fluid_depth;
in vec3 world;
in vec3 world_normal;
in float eye_depth;
uniform vec4 base;
#ifdef BASE_MAP
in vec2 texcoord;
layout(binding = 16) uniform sampler2D base_map;
#endif
uniform vec2 roughness;
uniform int has_fluid;
layout(location = 0, index = 0) out vec4 added;
layout(location = 0, index = 1) out vec4 through;
void main() {
  vec4 paint = base;
#ifdef BASE_MAP
  paint *= texture(base_map, texcoord);
#endif
  float surface = has_fluid != 0 ? texelFetch(fluid_depth, ivec2(gl_FragCoord.xy), 0).r : 1.0e6;
#ifdef BEHIND
  if (eye_depth <= surface) discard;
#else
  if (eye_depth > surface) discard;
#endif
  vec3 to_eye = normalize(camera.xyz - world);
  vec3 n = normalize(world_normal);
  if (dot(n, to_eye) < 0.0) n = -n;
  float facing = dot(n, to_eye);
  float mirroring = pane_reflectance(schlick(0.04, facing));
  float haze = paint.a * smoothstep(0.1, 0.6, roughness.y);
  // The way through the pane is longer at a slant.
  vec3 tint = pow(mix(vec3(1.0), paint.rgb, paint.a), vec3(1.0 / max(facing, 0.25)));
  // No shadow and no glint of its own: the mirrored softbox is the glint.
  vec3 key = key_light.rgb * (0.31830989 * max(dot(n, to_light_world.xyz), 0.0));
  vec3 mirror = mirrored(reflect(-to_eye, n)) * (1.0 - roughness.y);
  added = vec4(paint.rgb * (key + ambient_light(n)) * haze + mirror * mirroring, 0.0);
  through = vec4(tint * ((1.0 - haze) * (1.0 - mirroring)), 1.0);
}
