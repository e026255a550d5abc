// Particles moved to where their neighbours' mean is, and made ellipsoids: passes/smooth_centers on the GPU. A group has a batch of one
// cell's particles: it takes the particles of the 27 cells round it in hand, once, and eight invocations a particle go over them. What they
// sum is added up in one order, so that it comes out the same each time.
#include "shared.glsl"
#include "smoothing.glsl"
#include "particles.glsl"
layout(local_size_x = 128) in;
layout(std430, binding = 0) restrict writeonly buffer Centers { vec4 centers[]; };  // world, fluid index
struct Ellipsoid {
  vec4 xx_xy_xz_yy;  // m²
  vec4 yz_zz;
};
layout(std430, binding = 1) restrict writeonly buffer Ellipsoids { Ellipsoid ellipsoids[]; };
layout(std430, binding = 3) restrict readonly buffer Counts { uint counts[]; };
layout(std430, binding = 5) restrict readonly buffer Begins { uint begins[]; };
layout(std430, binding = 7) restrict readonly buffer Sorted { vec4 sorted[]; };
layout(std430, binding = 10) restrict readonly buffer Owners { uvec2 owners[]; };
layout(std430, binding = 11) restrict readonly buffer Batches { uvec4 batches[]; };
uniform int entries;
uniform vec2 lengths;  // reach and particle radius, m

const int kShare = 8;  // invocations a particle
const int kParticles = 128 / kShare;  // at a time
const int kHand = 512;                // neighbours at a time
const vec3 kNobody = vec3(1.0e15);
shared vec4 hand[kHand];
shared uint cell_begin[27];
shared uint cell_count[27];
shared Neighbourhood parts[128];

ivec3 neighbour(ivec3 middle, int c) { return middle + ivec3(c % 3, c / 3 % 3, c / 9) - 1; }

void look_up(ivec3 middle) {
  int local = int(gl_LocalInvocationID.x);
  barrier();
  if (local < 27) {
    uint entry = entry_of(neighbour(middle, local), entries);
    cell_begin[local] = begins[entry];
    cell_count[local] = counts[entry];
  }
  barrier();
}

// Neighbours `chunk` to chunk + kHand − 1, four invocations a cell. What lies in a cell's entry and is of another is nobody.
void take_in_hand(ivec3 middle, int chunk) {
  int local = int(gl_LocalInvocationID.x);
  barrier();
  int c = local >> 2;
  if (c < 27) {
    int before = -chunk;
    for (int i = 0; i < c; ++i) before += int(cell_count[i]);
    ivec3 cell = neighbour(middle, c);
    for (int k = local & 3; k < int(cell_count[c]); k += 4) {
      if (before + k < 0 || before + k >= kHand) continue;
      vec3 there = sorted[cell_begin[c] + uint(k)].xyz;
      hand[before + k] = vec4(cell_of(there, lengths.x) == cell ? there : kNobody, 0.0);
    }
  }
  barrier();
}

// Added to by what is in hand: every eighth from `part` on.
void add_neighbours(inout Neighbourhood n, vec3 at, int part, int in_hand) {
  float reach = lengths.x;
  float per_reach = 1.0 / reach;
  for (int k = part; k < in_hand; k += kShare) {
    vec3 way = hand[k].xyz - at;
    float squared = dot(way, way);
    float weight = squared < reach * reach ? neighbour_weight(sqrt(squared) * per_reach) : 0.0;
    vec3 weighed = weight * way;
    n.weights += weight;
    n.sum += weighed;
    n.square += weighed * way;
    n.mixed += weighed * way.yzx;
  }
}

// Those of the batch that are of one cell.
void smooth_cell(uvec4 batch, ivec3 middle, bool of_one_cell) {
  int local = int(gl_LocalInvocationID.x);
  int part = local % kShare;
  look_up(middle);
  int all_of_them = 0;
  for (int i = 0; i < 27; ++i) all_of_them += int(cell_count[i]);
  for (uint first = batch.y; first < batch.z; first += uint(kParticles)) {
    uint index = first + uint(local / kShare);
    vec4 particle = index < batch.z ? sorted[index] : vec4(0.0, 0.0, 0.0, -1.0);
    bool own = index < batch.z && (of_one_cell || cell_of(particle.xyz, lengths.x) == middle);
    Neighbourhood around = Neighbourhood(0.0, vec3(0.0), vec3(0.0), vec3(0.0));
    for (int chunk = 0; chunk < all_of_them; chunk += kHand) {
      if (first == batch.y || all_of_them > kHand) take_in_hand(middle, chunk);
      if (own) add_neighbours(around, particle.xyz, part, min(all_of_them - chunk, kHand));
    }
    parts[local] = around;
    barrier();
    if (own && part == 0) {
      for (int i = 1; i < kShare; ++i) {
        around.weights += parts[local + i].weights;
        around.sum += parts[local + i].sum;
        around.square += parts[local + i].square;
        around.mixed += parts[local + i].mixed;
      }
      uint into = batch.w + index - batch.y;
      mat3 e = smoothing_ellipsoid(around, lengths.x, lengths.y);
      centers[into] = vec4(particle.xyz + smoothing_step(around, lengths.x), particle.w);
      ellipsoids[into] = Ellipsoid(vec4(e[0][0], e[0][1], e[0][2], e[1][1]), vec4(e[1][2], e[2][2], 0.0, 0.0));
    }
    barrier();
  }
}

void main() {
  int all_batches = int(counts[batches_at(entries)]);
  for (int turn = group_index(); turn < all_batches; turn += all_groups()) {
    uvec4 batch = batches[turn];
    bool of_one_cell = owners[batch.x] != kNoCell;
    // Of an entry that cells share, each of them by itself, when its first particle is met.
    uint last = of_one_cell ? batch.y + 1u : batch.z;
    for (uint lead = batch.y; lead < last; ++lead) {
      ivec3 middle = cell_of(sorted[lead].xyz, lengths.x);
      bool met = false;
      for (uint k = batch.y; k < lead && !met; ++k) met = cell_of(sorted[k].xyz, lengths.x) == middle;
      if (!met) smooth_cell(batch, middle, of_one_cell);
    }
  }
}
