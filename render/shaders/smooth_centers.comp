// Splats moved to where their neighbours' mean is, and made ellipsoids: passes/smooth_centers on the GPU, an invocation each.
#include "frame_block.glsl"
#include "shared.glsl"
#include "smoothing.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Splats { vec4 splats[]; };  // eye position, fluid index
struct Shape {
  vec4 outline_depth;  // outline, depth_radius
  vec4 tilt;
};
layout(std430, binding = 1) writeonly buffer Shapes { Shape shapes[]; };
layout(std430, binding = 2) readonly buffer Places { float places[]; };  // by cell: all x, all y, all z; m, world
layout(std430, binding = 3) readonly buffer Begins { uint begins[]; };   // a cell each, x fastest, and the end
uniform int count;
uniform int column;    // floats in a column of places
uniform ivec3 lowest;  // cell
uniform ivec3 cells;
uniform vec2 lengths;  // reach and particle radius, m

Neighbourhood neighbourhood_of(vec3 at) {
  float reach = lengths.x;
  ivec3 middle = clamp(ivec3(floor(clamp(at / reach, vec3(-1.0e8), vec3(1.0e8)))) - lowest, ivec3(0), cells - 1);
  ivec3 low = max(middle - 1, ivec3(0));
  ivec3 high = min(middle + 1, cells - 1);
  Neighbourhood n = Neighbourhood(0.0, vec3(0.0), vec3(0.0), vec3(0.0));
  for (int z = low.z; z <= high.z; ++z) {
    for (int y = low.y; y <= high.y; ++y) {
      int row = (z * cells.y + y) * cells.x;
      uint end = begins[row + high.x + 1];
      for (uint k = begins[row + low.x]; k < end; ++k) {
        int i = int(k);
        vec3 way = vec3(places[i], places[column + i], places[2 * column + i]) - at;
        float squared = dot(way, way);
        if (squared >= reach * reach) continue;
        float weight = neighbour_weight(sqrt(squared) / reach);
        n.weights += weight;
        n.sum += weight * way;
        n.square += weight * way * way;
        n.mixed += weight * way * way.yzx;
      }
    }
  }
  return n;
}

void main() {
  int index = int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64 + int(gl_LocalInvocationID.x);
  if (index >= count) return;
  vec4 splat_in = splats[index];
  vec3 at = (world_from_eye * vec4(splat_in.xyz, 1.0)).xyz;
  Neighbourhood around = neighbourhood_of(at);
  mat3 turn = mat3(eye_from_world);
  vec3 center = (eye_from_world * vec4(at + smoothing_step(around, lengths.x), 1.0)).xyz;
  mat3 ellipsoid = turn * smoothing_ellipsoid(around, lengths.x, lengths.y) * transpose(turn);
  EllipsoidOutline shape = ellipsoid_outline(ellipsoid, center);
  splats[index] = vec4(center, splat_in.w);
  shapes[index] = Shape(vec4(shape.outline, shape.depth_radius), vec4(shape.tilt, 0.0, 0.0));
}
