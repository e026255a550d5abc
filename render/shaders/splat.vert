// A particle as one triangle round its disc, or with SHAPED round its ellipse. The splats are in eye space, culled and finite
// (passes/splats.h).
#ifdef SHAPED
flat out vec3 tilt;  // and the depth radius
#endif
#include "splat_place.glsl"
out vec2 disc;
flat out float center_depth;
flat out uint fluid;
void main() {
  int index = gl_VertexID / 3;
  vec4 splat_in = splats[index];
  int corner = gl_VertexID % 3;
  vec2 at = corner == 0 ? vec2(0.0, 2.0) : vec2(corner == 1 ? -1.7320508 : 1.7320508, -1.0);
  SplatPlace place = splat_place(splat_in.xyz);
  disc = at;
  center_depth = place.depth;
  fluid = uint(splat_in.w);
#ifdef SHAPED
  Shape shape = shapes[index];
  tilt = vec3(shape.tilt.xy, shape.outline_depth.w);
  vec2 off = off_of_disc(shape.outline_depth.xyz, at);
#else
  vec2 off = at * splat.x;
#endif
  gl_Position = vec4(place.center + off * place.scale, 0.0, 1.0);
}
