// A particle as one triangle round what it has a share in (mixing.glsl).
#include "mixing.glsl"
flat out vec3 center;
flat out float reach;
flat out int channel;
void main() {
  vec4 splat_in = splats[gl_VertexID / 3];
  int corner = gl_VertexID % 3;
  vec2 at = corner == 0 ? vec2(0.0, 2.0) : vec2(corner == 1 ? -1.7320508 : 1.7320508, -1.0);
  SplatPlace place = splat_place(splat_in.xyz);
  center = splat_in.xyz;
  reach = reach_at(place.depth);
  channel = int(splat_in.w) - first;
  bool here = channel >= 0 && channel < 4;
  gl_Position = here ? vec4(place.center + at * reach * place.scale, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
