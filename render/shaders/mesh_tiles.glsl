// Meshes by compute shaders: a group looks after 32 × 32 pixels, an invocation after four of them. It goes through those groups of 64
// triangles whose boxes touch the tile, in the order in which they would be drawn. Invocations that a chip runs as one (up to 32) have blocks of
// 8 × 4 pixels, one below the other, and a list of their own of the triangles that touch these: on a ball seen small each triangle is few
// pixels, and what takes long is to ask.
#include "frame_block.glsl"
#include "mesh_triangle.glsl"
layout(local_size_x = 16, local_size_y = 16) in;
layout(std430, binding = 2) restrict readonly buffer Triangles { Triangle triangles[]; };
layout(std430, binding = 3) restrict readonly buffer Boxes { uvec2 boxes[]; };
struct Item {
  vec4 base;      // colour, opacity
  vec4 surface;   // metallic, roughness
  vec4 emissive;
};
layout(std430, binding = 4) restrict readonly buffer Items { Item items[]; };
layout(std430, binding = 5) restrict readonly buffer Groups { uvec2 groups[]; };  // boxes of 64 triangles each
uniform int count;  // groups
uniform float near_plane;

const int kTile = 32;
const int kPixels = 4;  // of an invocation

// Of the tile: the corner of the first of this invocation's blocks; the others lie 8 rows on each.
ivec2 first_block() {
  int block = int(gl_LocalInvocationIndex >> 5);
  return ivec2((block & 3) * 8, (block >> 2) * 4);
}
ivec2 texel_of(int k) {
  int place = int(gl_LocalInvocationIndex & 31u);
  return ivec2(gl_WorkGroupID.xy) * kTile + first_block() + ivec2(place & 7, (place >> 3) + 8 * k);
}
// A ray's x and y at depth 1.
vec2 ray_of(ivec2 texel) { return eye_position(vec2(texel) + 0.5, 1.0).xy; }

// What of a triangle meets() looks at: the rest is fetched where it is hit.
struct Facet {
  vec4 a;  // corner, plane.z
  vec4 b;  // corner, plane.x
  vec4 c;  // corner, plane.y
};
Facet facet_of(Triangle t) { return Facet(vec4(t.a.xyz, t.normal_a.w), t.b, t.c); }

struct Hit {
  vec3 weights;  // of the corners
  float depth;   // m
  bool outer;    // its outer side is seen
};

// Of neighbours that share an edge through a pixel's middle one has it.
bool right_of(float area, vec2 from, vec2 to) {
  return area > 0.0 || (area == 0.0 && (to.y > from.y || (to.y == from.y && to.x > from.x)));
}

// Where a ray meets a triangle. Corners are taken off along the ray to the eye's plane, which is exact to rounding of what is left,
// however far they are; the areas about an edge are the same from both its triangles, but for the sign.
bool meets(Facet t, vec2 ray, out Hit hit) {
  precise vec2 a = fma(vec2(-t.a.z), ray, t.a.xy);
  precise vec2 b = fma(vec2(-t.b.z), ray, t.b.xy);
  precise vec2 c = fma(vec2(-t.c.z), ray, t.c.xy);
  precise float to_a = b.x * c.y - c.x * b.y;
  precise float to_b = c.x * a.y - a.x * c.y;
  precise float to_c = a.x * b.y - b.x * a.y;
  float all_of_it = to_a + to_b + to_c;
  hit.outer = all_of_it > 0.0;
  bool inside = hit.outer ? right_of(to_a, b, c) && right_of(to_b, c, a) && right_of(to_c, a, b)
                          : all_of_it < 0.0 && right_of(-to_a, c, b) && right_of(-to_b, a, c) && right_of(-to_c, b, a);
  if (!inside) return false;  // most rays pass beside
  hit.weights = vec3(to_a, to_b, to_c) / all_of_it;
  vec3 depths = vec3(t.a.z, t.b.z, t.c.z);
  float slope = dot(vec3(t.b.w, t.c.w, t.a.w), vec3(ray, 1.0));
  float in_plane = slope > 0.0 ? 1.0 / slope : dot(hit.weights, depths);
  hit.depth = clamp(in_plane, min(depths.x, min(depths.y, depths.z)), max(depths.x, max(depths.y, depths.z)));
  return hit.depth >= near_plane && hit.depth <= camera.w;
}

vec3 normal_of(Triangle t, vec3 weights) {
  return normalize(t.normal_a.xyz * weights.x + t.normal_b.xyz * weights.y + t.normal_c.xyz * weights.z);
}

vec3 world_of(vec2 ray, float depth) { return (world_from_eye * vec4(vec3(ray, -1.0) * depth, 1.0)).xyz; }

// Of the tile's own axes: whether a box touches it.
bool touches_tile(uvec2 box, out ivec4 in_tile) {
  ivec2 tile = ivec2(gl_WorkGroupID.xy) * kTile;
  in_tile = ivec4(ivec2(box.x & 0xffffu, box.x >> 16) - tile, ivec2(box.y & 0xffffu, box.y >> 16) - tile);
  return all(lessThan(in_tile.xy, ivec2(kTile))) && all(greaterThanEqual(in_tile.zw, ivec2(0))) && all(lessThanEqual(in_tile.xy, in_tile.zw));
}

shared uint words[64];  // a bit for each of 256: the groups that touch the tile, then of the triangles at hand eight words for each 32 invocations
shared int found_group[256];  // those that touch the tile, in their order
shared int found_groups;
shared uint hit_blocks[256];  // of the triangles at hand, a bit for each 8 × 4 pixels of the tile: 8 · column + row
shared Facet facets[256];

// No bit is set, once all have read those that were.
void clear_words() {
  barrier();
  if (gl_LocalInvocationIndex < 64u) words[gl_LocalInvocationIndex] = 0u;
  barrier();
}
// This invocation's bit of the 256 that begin with word 8 · row.
void set_bit(int row) { atomicOr(words[8 * row + int(gl_LocalInvocationIndex >> 5)], 1u << (gl_LocalInvocationIndex & 31u)); }

// Which of the 256 groups of 64 triangles from `base` on touch the tile.
void look_for_groups(int base) {
  uint local = gl_LocalInvocationIndex;
  clear_words();
  ivec4 box;
  bool near = base + int(local) < count && touches_tile(groups[base + int(local)], box);
  if (near) set_bit(0);
  barrier();
  int before = 0;
  for (int word = 0; word < 8; ++word) {
    if (word < int(local >> 5)) before += bitCount(words[word]);
    if (word == int(local >> 5)) before += bitCount(words[word] & ((1u << (local & 31u)) - 1u));
  }
  if (near) found_group[before] = base + int(local);
  if (local == 255u) found_groups = before + (near ? 1 : 0);
  barrier();
}

// The triangle at `place` of those at hand, which are of the groups found from `from` on.
int triangle_at(int from, int place) { return 64 * found_group[from + (place >> 6)] + (place & 63); }

// A function that is linear in the picture, as the areas of meets() are in the ray: its value in the tile's middle, what it changes by
// from pixel to pixel.
struct Slope {
  float middle;
  vec2 per_pixel;
};
Slope area_slope(vec3 b, vec3 c, vec2 b_off, vec2 c_off, vec2 pixel) {
  return Slope(b_off.x * c_off.y - c_off.x * b_off.y,
               pixel * vec2(c.z * b_off.y - b.z * c_off.y, b.z * c_off.x - c.z * b_off.x));
}

// In which of the tile's blocks of 8 × 4 pixels a ray may meet a triangle, of those in a box of blocks: where each of its areas may be
// positive, or each negative. Half a pixel of room all round is far beyond what rounding moves an edge by.
uint blocks_met(Facet t, ivec4 box) {
  vec2 middle = ray_of(ivec2(gl_WorkGroupID.xy) * kTile + kTile / 2) - unproject.xy * picture.zw;
  vec2 pixel = 2.0 * unproject.xy * picture.zw;  // of a ray
  vec2 a = t.a.xy - t.a.z * middle;
  vec2 b = t.b.xy - t.b.z * middle;
  vec2 c = t.c.xy - t.c.z * middle;
  Slope slopes[3] = Slope[3](area_slope(t.b.xyz, t.c.xyz, b, c, pixel), area_slope(t.c.xyz, t.a.xyz, c, a, pixel),
                             area_slope(t.a.xyz, t.b.xyz, a, b, pixel));
  uint blocks = 0u;
  for (int column = box.x >> 3; column <= box.z >> 3; ++column) {
    for (int row = box.y >> 2; row <= box.w >> 2; ++row) {
      vec2 at = vec2(8 * column + 4, 4 * row + 2) - float(kTile / 2);
      bool positive = true;
      bool negative = true;
      for (int k = 0; k < 3; ++k) {
        float value = slopes[k].middle + dot(slopes[k].per_pixel, at);
        float room = dot(abs(slopes[k].per_pixel), vec2(4.0, 2.0));
        positive = positive && value + room >= 0.0;
        negative = negative && value - room <= 0.0;
      }
      if (positive || negative) blocks |= 1u << (8 * column + row);
    }
  }
  return blocks;
}

// Takes the triangles of the next four groups in hand: which of them touch whose pixels.
void look_for(int from) {
  uint local = gl_LocalInvocationIndex;
  clear_words();
  ivec4 box;
  if (from + int(local >> 6) < found_groups) {
    int index = triangle_at(from, int(local));
    if (touches_tile(boxes[index], box)) {
      Facet facet = facet_of(triangles[index]);
      uint blocks = blocks_met(facet, clamp(box, ivec4(0), ivec4(kTile - 1)));
      facets[local] = facet;
      hit_blocks[local] = blocks;
      for (int column = 0; column < 4; ++column) {
        for (int odd = 0; odd < 2; ++odd) {
          if ((blocks >> 8 * column & 0x55u << odd) != 0u) set_bit(column + 4 * odd);
        }
      }
    }
  }
  barrier();
}

// Those of them that touch this invocation's and its neighbours' pixels, 32 at a time, a bit each.
uint at_hand(int word) { return words[8 * int(gl_LocalInvocationIndex >> 5) + word]; }
// In which of the invocation's four blocks pixels of one of them may lie, a bit every other.
uint blocks_touched(int place) {
  int block = int(gl_LocalInvocationIndex >> 5);
  return hit_blocks[place] >> (8 * (block & 3) + (block >> 2));
}
