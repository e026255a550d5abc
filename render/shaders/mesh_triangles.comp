// Triangles of one mesh as tiles of pixels look through them: in eye axes, with the box of pixels that each may cover, and that
// of each 64 of them.
#include "frame_block.glsl"
#include "mesh_triangle.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Vertices { float vertices[]; };  // position and normal, six each
layout(std430, binding = 1) readonly buffer Corners { uint corners[]; };     // three each
layout(std430, binding = 2) writeonly buffer Triangles { Triangle triangles[]; };
layout(std430, binding = 3) writeonly buffer Boxes { uvec2 boxes[]; };
layout(std430, binding = 5) writeonly buffer Groups { uvec2 groups[]; };
uniform int count;
uniform int first;  // where this mesh's are put: a multiple of 64
uniform int item;
uniform int sides;  // what is seen of it: 1 the outside, −1 the inside, 0 both
uniform float near_plane;
uniform mat4 model;

const uvec2 kNoBox = uvec2(0xffffffffu, 0u);

// The picture's place of an eye point before the eye (x, y, depth), in pixels.
vec2 place(vec3 at) { return ((at.xy / at.z / unproject.xy - unproject.zw) * 0.5 + 0.5) * picture.xy; }

// Corners lie on 256ths of a pixel, as chips have them that draw triangles: so the same pixels are covered.
vec2 snapped(vec3 at) {
  vec2 pixel = round(place(at) * 256.0) / 256.0;
  return eye_position(pixel, at.z).xy;
}

// Low and high corner, whole numbers below 65536; none: the low one beyond all.
uvec2 packed_box(ivec2 low, ivec2 high) { return uvec2(uint(low.x) | uint(low.y) << 16, uint(high.x) | uint(high.y) << 16); }

shared ivec2 group_low;
shared ivec2 group_high;

// The box of a triangle that is put where it is looked for.
uvec2 put_triangle(int index) {
  vec3 at[3];
  vec3 normal[3];
  for (int k = 0; k < 3; ++k) {
    int v = 6 * int(corners[3 * index + k]);
    vec4 world = model * vec4(vertices[v], vertices[v + 1], vertices[v + 2], 1.0);
    normal[k] = mat3(model) * vec3(vertices[v + 3], vertices[v + 4], vertices[v + 5]);
    at[k] = (eye_from_world * world).xyz * vec3(1.0, 1.0, -1.0);
  }
  // The part beyond the near plane.
  bool cut = false;
  vec2 low = vec2(1.0e9);
  vec2 high = vec2(-1.0e9);
  for (int k = 0; k < 3; ++k) {
    vec3 a = at[k];
    vec3 b = at[(k + 1) % 3];
    if (a.z >= near_plane) {
      vec2 p = place(a);
      low = min(low, p);
      high = max(high, p);
    }
    if ((a.z >= near_plane) != (b.z >= near_plane)) {
      cut = true;
      vec2 p = place(vec3(mix(a.xy, b.xy, (near_plane - a.z) / (b.z - a.z)), near_plane));
      low = min(low, p);
      high = max(high, p);
    }
  }
  // Depths are those of the plane it is in, not of the one through its corners as they are snapped: that of a floor would be off by
  // a tenth of a millimetre a metre.
  vec3 plane = cross(at[1] - at[0], at[2] - at[0]);
  float distance = dot(plane, at[0]);
  plane = abs(distance) > 1.0e-12 ? plane / distance : vec3(0.0);
  // Positive where the eye is on its outer side; depth points away from the eye, which turns the hand.
  float outside = distance;
  bool seen = sides == 0 || outside * float(sides) > 0.0;
  // Pixels whose middles it may cover, and no more: what is a few pixels large touches few tiles' parts then, and what lies between
  // middles none. Room for rounding, and for corners that are moved.
  vec2 room = cut ? vec2(1.5) : 0.02 + 2.0e-6 * max(abs(low), abs(high));
  ivec2 from = ivec2(clamp(ceil(low - 0.5 - room), vec2(0.0), picture.xy));
  ivec2 to = ivec2(clamp(floor(high - 0.5 + room), vec2(-1.0), picture.xy - 1.0));
  bool any_pixel = seen && all(lessThanEqual(from, to)) && low.x <= high.x;
  for (int k = 0; k < 3; ++k) {
    if (at[k].z >= near_plane) at[k].xy = snapped(at[k]);
  }
  triangles[first + index] = Triangle(vec4(at[0], float(item)), vec4(at[1], plane.x), vec4(at[2], plane.y), vec4(normal[0], plane.z), vec4(normal[1], 0.0), vec4(normal[2], 0.0));
  return any_pixel ? packed_box(from, to) : kNoBox;
}

void main() {
  int group = int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
  int index = group * 64 + int(gl_LocalInvocationID.x);
  if (gl_LocalInvocationID.x == 0u) {
    group_low = ivec2(0xffff);
    group_high = ivec2(0);
  }
  barrier();
  uvec2 box = index < count ? put_triangle(index) : kNoBox;
  boxes[first + index] = box;
  if (box != kNoBox) {
    atomicMin(group_low.x, int(box.x & 0xffffu));
    atomicMin(group_low.y, int(box.x >> 16));
    atomicMax(group_high.x, int(box.y & 0xffffu));
    atomicMax(group_high.y, int(box.y >> 16));
  }
  barrier();
  if (gl_LocalInvocationID.x == 0u) groups[first / 64 + group] = packed_box(group_low, group_high);
}
