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
  center_depth = place.depth;
  fluid = uint(splat_in.w);
#ifdef SHAPED
  Shape shape = shapes[index];
  tilt = vec3(shape.tilt.xy, shape.outline_depth.w);
  vec3 outline = shape.outline_depth.xyz;
#else
  vec3 outline = vec3(splat.x, 0.0, splat.x);
#endif
  // A chip puts corners on 256ths of a pixel, and what it lays between them with them: near a disc's rim, where depths fall off steeply,
  // that showed. So they are put there first, and the disc is asked where they lie.
#ifdef FRONT
  vec2 steps = 128.0 * picture.xy;
#else
  vec2 steps = 128.0 * floor(0.5 * (picture.xy + 1.0));  // at half size
#endif
  vec2 corner_at = round((place.center + off_of_disc(outline, at) * place.scale) * steps) / steps;
  disc = disc_of_off(outline, (corner_at - place.center) / place.scale);
  gl_Position = vec4(corner_at, 0.0, 1.0);
}
