// Particles moved to where their neighbours' mean is, and made ellipsoids: passes/smooth_centers on the GPU, an invocation each.
#include "shared.glsl"
#include "smoothing.glsl"
#include "particles.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer Centers { vec4 centers[]; };  // world, fluid index; −1: no particle
struct Ellipsoid {
  vec4 xx_xy_xz_yy;  // m²
  vec4 yz_zz;
};
layout(std430, binding = 1) writeonly buffer Ellipsoids { Ellipsoid ellipsoids[]; };
layout(std430, binding = 3) readonly buffer Counts { uint counts[]; };
layout(std430, binding = 5) readonly buffer Begins { uint begins[]; };
layout(std430, binding = 7) buffer Sorted { vec4 sorted[]; };
uniform int count;
uniform int entries;
uniform vec2 lengths;  // reach and particle radius, m

Neighbourhood neighbourhood_of(vec3 at) {
  float reach = lengths.x;
  ivec3 middle = cell_of(at, reach);
  Neighbourhood n = Neighbourhood(0.0, vec3(0.0), vec3(0.0), vec3(0.0));
  for (int z = middle.z - 1; z <= middle.z + 1; ++z) {
    for (int y = middle.y - 1; y <= middle.y + 1; ++y) {
      for (int x = middle.x - 1; x <= middle.x + 1; ++x) {
        uint entry = entry_of(ivec3(x, y, z), entries);
        uint first = begins[entry];
        uint end = first + counts[entry];
        for (uint k = first; k < end; ++k) {
          vec3 there = sorted[k].xyz;
          vec3 way = there - at;
          float squared = dot(way, way);
          if (squared >= reach * reach || cell_of(there, reach) != ivec3(x, y, z)) continue;
          float weight = neighbour_weight(sqrt(squared) / reach);
          n.weights += weight;
          n.sum += weight * way;
          n.square += weight * way * way;
          n.mixed += weight * way * way.yzx;
        }
      }
    }
  }
  return n;
}

void main() {
  int index = invocation();
  if (index >= count) return;
  if (uint(index) >= counts[entries]) {  // fewer are drawn
    centers[index] = vec4(0.0, 0.0, 0.0, -1.0);
    sorted[index].w = -1.0;
    return;
  }
  vec4 particle = sorted[index];
  Neighbourhood around = neighbourhood_of(particle.xyz);
  mat3 e = smoothing_ellipsoid(around, lengths.x, lengths.y);
  centers[index] = vec4(particle.xyz + smoothing_step(around, lengths.x), particle.w);
  ellipsoids[index] = Ellipsoid(vec4(e[0][0], e[0][1], e[0][2], e[1][1]), vec4(e[1][2], e[2][2], 0.0, 0.0));
}
