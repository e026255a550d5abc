// Glass by compute shaders: translucent.frag, all panes of a pixel at once, in the order in which they would be drawn: those before the
// fluid's surface. BEHIND: those behind it, and what is seen through it is copied for the fluid.
#include "glass.glsl"
#include "mesh_tiles.glsl"
#include "shared.glsl"
#include "bilateral.glsl"
layout(binding = 0, rgba16f) uniform image2D color;
#ifdef BEHIND
layout(binding = 1) writeonly uniform image2D scene_color;
#endif
layout(binding = 0) uniform sampler2D fluid_depth;
layout(binding = 1) uniform sampler2D scene_depth;
uniform int has_fluid;
shared int any_in_tile;  // of whose pixels panes may be drawn

struct Seen {
  float surface;  // depths
  float scene;
  vec2 ray;
  vec3 added;  // by the panes, and what they leave
  vec3 through;
  bool touched;
};

bool lies_there(Seen at, float depth) {
#ifdef BEHIND
  return depth > at.surface && depth < at.scene;
#else
  return depth <= min(at.surface, at.scene);
#endif
}

// Lays the panes of the triangles in hand over each other.
void add_panes(int from, inout Seen at[kPixels]) {
  for (int word = 0; word < 8; ++word) {
    for (uint left = at_hand(word); left != 0u; left &= left - 1u) {
      int place = 32 * word + findLSB(left);
      uint blocks = blocks_touched(place);
      Facet facet = facets[place];
      int index = triangle_at(from, place);
      for (int k = 0; k < kPixels; ++k) {
        Hit hit;
        if ((blocks >> 2 * k & 1u) == 0u || !meets(facet, at[k].ray, hit) || !lies_there(at[k], hit.depth)) continue;
        Triangle t = triangles[index];
        Item item = items[int(t.a.w)];
        Pane pane = glass_pane(world_of(at[k].ray, hit.depth), normal_of(t, hit.weights), item.base, item.surface.y);
        at[k].added = at[k].added * pane.through + pane.added;
        at[k].through *= pane.through;
        at[k].touched = true;
      }
    }
  }
}

void main() {
  Seen at[kPixels];
#ifdef BEHIND
  bool wanted = false;
#else
  bool wanted = true;
#endif
  for (int k = 0; k < kPixels; ++k) {
    ivec2 texel = min(texel_of(k), ivec2(picture.xy) - 1);
    // A pane that stands on something lies at its depth: it is seen, by all rays alike. Two hundredths of a millimetre
    // at a metre, far beyond what rounding moves either by.
    at[k].scene = 1.00002 * texelFetch(scene_depth, texel, 0).r;
    at[k].surface = has_fluid != 0 ? texelFetch(fluid_depth, texel, 0).r : 1.0e6;
    at[k].ray = ray_of(texel_of(k));
    at[k].added = vec3(0.0);
    at[k].through = vec3(1.0);
    at[k].touched = false;
    wanted = wanted || at[k].surface < at[k].scene;
  }
  if (gl_LocalInvocationIndex == 0u) any_in_tile = 0;
  barrier();
  if (wanted) any_in_tile = 1;
  barrier();
  int groups_here = any_in_tile != 0 ? count : 0;
  for (int base = 0; base < groups_here; base += 256) {
    look_for_groups(base);
    for (int from = 0; from < found_groups; from += 4) {
      look_for(from);
      if (wanted) add_panes(from, at);
    }
  }
  for (int k = 0; k < kPixels; ++k) {
    ivec2 texel = texel_of(k);
    if (any(greaterThanEqual(texel, ivec2(picture.xy)))) continue;
#ifndef BEHIND
    if (!at[k].touched) continue;
#endif
    vec4 value = imageLoad(color, texel);
    value = vec4(value.rgb * at[k].through + at[k].added, value.a);
    if (at[k].touched) imageStore(color, texel, value);
#ifdef BEHIND
    imageStore(scene_color, texel, value);
#endif
  }
}
