// A particle as one triangle round its disc. The splats are in eye space, culled and finite (passes/splats.h).
#include "frame_block.glsl"
layout(std430, binding = 0) readonly buffer Splats { vec4 splats[]; };  // eye position, fluid index
out vec2 disc;
flat out float center_depth;
flat out uint fluid;
void main() {
  vec4 splat_in = splats[gl_VertexID / 3];
  int corner = gl_VertexID % 3;
  vec2 at = corner == 0 ? vec2(0.0, 2.0) : vec2(corner == 1 ? -1.7320508 : 1.7320508, -1.0);
  float d = -splat_in.z;
  vec2 scale = vec2(1.0) / (unproject.xy * d);
  vec2 center = splat_in.xy * scale - unproject.zw;
  disc = at;
  center_depth = d;
  fluid = uint(splat_in.w);
  gl_Position = vec4(center + at * splat.x * scale, 0.0, 1.0);
}
