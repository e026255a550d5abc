// Particles moved to where their neighbours' mean is, and made ellipsoids: passes/smooth_centers on the GPU. Four invocations share the
// 27 cells round a particle; what they sum is added up in one order, so that it comes out the same each time. Those that a chip runs as one
// (32) have a share each of as many particles that follow each other: mostly of one cell, so that they read the same neighbours at the same
// time. SEEN: of those alone that cells_deep.comp listed.
#include "shared.glsl"
#include "smoothing.glsl"
#include "particles.glsl"
layout(local_size_x = 128) in;
layout(std430, binding = 0) writeonly buffer Centers { vec4 centers[]; };  // world, fluid index; −1: not drawn
struct Ellipsoid {
  vec4 xx_xy_xz_yy;  // m²
  vec2 yz_zz;
  uint mean;  // of the neighbours (packed_mean)
  float weights;
};
layout(std430, binding = 1) writeonly buffer Ellipsoids { Ellipsoid ellipsoids[]; };
layout(std430, binding = 3) restrict readonly buffer Counts { uint counts[]; };
layout(std430, binding = 5) restrict readonly buffer Begins { uint begins[]; };
layout(std430, binding = 7) restrict readonly buffer Sorted { vec4 sorted[]; };
#ifdef SEEN
layout(std430, binding = 8) restrict readonly buffer Seen { uint seen[]; };  // sorted particles
#endif
uniform int count;
uniform int entries;
uniform vec2 lengths;  // reach and particle radius, m

const int kShare = 4;       // invocations a particle
const int kParticles = 32;  // in a group
const int kMoments = 10;
// Particles side by side, for a chip's memory banks.
shared float moments[kMoments][kShare * kParticles];

void put(int at, Neighbourhood n) {
  moments[0][at] = n.weights;
  for (int k = 0; k < 3; ++k) {
    moments[1 + k][at] = n.sum[k];
    moments[4 + k][at] = n.square[k];
    moments[7 + k][at] = n.mixed[k];
  }
}

// All shares of a particle, in their order.
Neighbourhood together(int own) {
  float m[kMoments];
  for (int k = 0; k < kMoments; ++k) {
    m[k] = moments[k][own];
    for (int part = 1; part < kShare; ++part) m[k] += moments[k][part * kParticles + own];
  }
  return Neighbourhood(m[0], vec3(m[1], m[2], m[3]), vec3(m[4], m[5], m[6]), vec3(m[7], m[8], m[9]));
}

Neighbourhood part_of(vec3 at, int part) {
  float reach = lengths.x;
  ivec3 middle = cell_of(at, reach);
  Neighbourhood n = Neighbourhood(0.0, vec3(0.0), vec3(0.0), vec3(0.0));
  for (int c = part; c < 27; c += kShare) {
    ivec3 cell = middle + ivec3(c % 3, c / 3 % 3, c / 9) - 1;
    // Out of reach altogether: rounding moves it by far less than a ten-thousandth.
    vec3 off = clamp(at, vec3(cell) * reach, vec3(cell + 1) * reach) - at;
    if (dot(off, off) >= 1.0001 * reach * reach) continue;
    uint entry = entry_of(cell, entries);
    uint first = begins[entry];
    uint end = first + counts[entry];
    for (uint k = first; k < end; ++k) {
      vec3 there = sorted[k].xyz;
      vec3 way = there - at;
      float squared = dot(way, way);
      if (squared >= reach * reach || cell_of(there, reach) != cell) continue;
      float weight = neighbour_weight(sqrt(squared) / reach);
      n.weights += weight;
      n.sum += weight * way;
      n.square += weight * way * way;
      n.mixed += weight * way * way.yzx;
    }
  }
  return n;
}

void main() {
  int local = int(gl_LocalInvocationID.x);
  int own = local % kParticles;
  int part = local / kParticles;
#ifdef SEEN
  int all_of_them = int(counts[seen_at_end(entries)]);
#else
  int all_of_them = count;
#endif
  // As many groups as there may be on an axis go over all of them by turns.
  int at_once = all_groups() * kParticles;
  for (int first = group_index() * kParticles; first < all_of_them; first += at_once) {
    int index = first + own;
#ifdef SEEN
    bool drawn = index < all_of_them;
    vec4 particle = drawn ? sorted[seen[index]] : vec4(0.0, 0.0, 0.0, -1.0);
#else
    bool drawn = index < count && uint(index) < counts[drawn_at(entries)];  // fewer are drawn than given
    vec4 particle = drawn ? sorted[index] : vec4(0.0, 0.0, 0.0, -1.0);
#endif
    if (drawn) put(local, part_of(particle.xyz, part));
    barrier();
    if (drawn && part == 0) {
      Neighbourhood around = together(own);
      mat3 e = smoothing_ellipsoid(around, lengths.x, lengths.y);
      centers[index] = vec4(particle.xyz + smoothing_step(around, lengths.x), particle.w);
      ellipsoids[index] = Ellipsoid(vec4(e[0][0], e[0][1], e[0][2], e[1][1]), vec2(e[1][2], e[2][2]),
                                    packed_mean(neighbours_mean(around) / lengths.x), around.weights);
    } else if (part == 0 && index < count) {
      centers[index] = particle;
    }
    barrier();
  }
}
