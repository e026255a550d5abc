// Meshes by compute shaders: a group looks after 32 × 32 pixels, an invocation after four of them, and all go through the triangles
// whose boxes touch the tile, in the order in which they would be drawn. Invocations that a chip runs as one (up to 32) have blocks of
// 8 × 4 pixels, so that they pass over small triangles elsewhere together.
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
uniform int count;
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
  hit.weights = vec3(to_a, to_b, to_c) / all_of_it;
  vec3 depths = vec3(t.a.z, t.b.z, t.c.z);
  float slope = dot(vec3(t.b.w, t.c.w, t.a.w), vec3(ray, 1.0));
  float in_plane = slope > 0.0 ? 1.0 / slope : dot(hit.weights, depths);
  hit.depth = clamp(in_plane, min(depths.x, min(depths.y, depths.z)), max(depths.x, max(depths.y, depths.z)));
  return inside && hit.depth >= near_plane && hit.depth <= camera.w;
}

vec3 normal_of(Triangle t, vec3 weights) {
  return normalize(t.normal_a.xyz * weights.x + t.normal_b.xyz * weights.y + t.normal_c.xyz * weights.z);
}

vec3 world_of(vec2 ray, float depth) { return (world_from_eye * vec4(vec3(ray, -1.0) * depth, 1.0)).xyz; }

shared uint touching[8];
shared ivec4 touched_box[256];  // low and high, in the tile
shared Facet facets[256];

// Which of the 256 triangles from `first` on touch the tile, a bit each in `touching`.
void look_for(int first) {
  uint local = gl_LocalInvocationIndex;
  barrier();
  if (local < 8u) touching[local] = 0u;
  barrier();
  int index = first + int(local);
  if (index < count) {
    uvec2 box = boxes[index];
    ivec2 low = ivec2(box.x & 0xffffu, box.x >> 16);
    ivec2 high = ivec2(box.y & 0xffffu, box.y >> 16);
    ivec2 tile = ivec2(gl_WorkGroupID.xy) * kTile;
    if (all(lessThan(low, tile + kTile)) && all(greaterThanEqual(high, tile))) {
      atomicOr(touching[local >> 5], 1u << (local & 31u));
      touched_box[local] = ivec4(low - tile, high - tile);
      facets[local] = facet_of(triangles[index]);
    }
  }
  barrier();
}

// In which of the invocation's four blocks pixels of the box lie that look_for() found at `place`, a bit each.
uint blocks_touched(int place) {
  ivec4 box = touched_box[place];
  ivec2 block = first_block();
  uint blocks = 0u;
  if (box.x < block.x + 8 && box.z >= block.x) {
    for (int k = 0; k < kPixels; ++k) {
      int row = block.y + 8 * k;
      if (box.y < row + 4 && box.w >= row) blocks |= 1u << k;
    }
  }
  return blocks;
}
