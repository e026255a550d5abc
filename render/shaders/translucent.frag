// A glass: what lies behind (BEHIND) or in front of the fluid's surface. Two outputs of one blend: light added, and the share of
// what is behind that stays, per channel.
#include "glass.glsl"
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
  Pane pane = glass_pane(world, normalize(world_normal), paint, roughness.y);
  added = vec4(pane.added, 0.0);
  through = vec4(pane.through, 1.0);
}
