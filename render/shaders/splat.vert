// A particle as one triangle round its disc, or with SHAPED round its ellipse. The splats are in eye space, culled and finite
// (passes/splats.h).
#include "frame_block.glsl"
layout(std430, binding = 0) readonly buffer Splats { vec4 splats[]; };  // eye position, fluid index
#ifdef SHAPED
struct Shape {
  vec4 outline_depth;  // outline, depth_radius
  vec4 tilt;
};
layout(std430, binding = 1) readonly buffer Shapes { Shape shapes[]; };
flat out vec3 tilt;  // and the depth radius
#endif
out vec2 disc;
flat out float center_depth;
flat out uint fluid;
void main() {
  int index = gl_VertexID / 3;
  vec4 splat_in = splats[index];
  int corner = gl_VertexID % 3;
  vec2 at = corner == 0 ? vec2(0.0, 2.0) : vec2(corner == 1 ? -1.7320508 : 1.7320508, -1.0);
  float d = -splat_in.z;
  vec2 scale = vec2(1.0) / (unproject.xy * d);
  vec2 center = splat_in.xy * scale - unproject.zw;
  disc = at;
  center_depth = d;
  fluid = uint(splat_in.w);
#ifdef SHAPED
  Shape shape = shapes[index];
  tilt = vec3(shape.tilt.xy, shape.outline_depth.w);
  vec2 off = vec2(shape.outline_depth.x * at.x, shape.outline_depth.y * at.x + shape.outline_depth.z * at.y);
#else
  vec2 off = at * splat.x;
#endif
  gl_Position = vec4(center + off * scale, 0.0, 1.0);
}
