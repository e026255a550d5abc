// Glass by compute shaders: translucent.frag, all panes of a pixel at once, in the order in which they would be drawn: those before the
// fluid's surface. BEHIND: those behind it, and what is seen through it is copied for the fluid. BOTH: one after the other, by the same
// lists, over the meshes' colour as they were lit; where there is fluid the composite lays those before it over it.
#include "glass.glsl"
#include "mesh_tiles.glsl"
#include "shared.glsl"
#include "bilateral.glsl"
layout(binding = 0, rgba16f) uniform image2D color;
#ifdef BEHIND
layout(binding = 1) writeonly uniform image2D scene_color;
#endif
#ifdef BOTH
layout(binding = 2) writeonly uniform image2D pane_added;
layout(binding = 3) writeonly uniform image2D pane_through;
#endif
layout(binding = 0) uniform sampler2D fluid_depth;
layout(binding = 1) uniform sampler2D scene_depth;
#ifdef BOTH
#include "resolve.glsl"
layout(binding = 2) uniform sampler2D mesh_color;
layout(binding = 3) uniform sampler2D occlusion;
#endif
uniform int has_fluid;
shared int any_in_tile;  // of whose pixels something may lie between

const int kBehind = 0;
const int kBefore = 1;
#ifdef BEHIND
const int kFirst = kBehind;
#else
const int kFirst = kBefore;
#endif
#if defined(BEHIND) && !defined(BOTH)
const int kLast = kBehind;
#else
const int kLast = kBefore;
#endif

struct Seen {
  float surface;  // depths
  float scene;
  vec2 ray;
  vec3 added;  // by the panes of a part, and what they leave
  vec3 through;
  bool touched;
};

bool lies_there(int part, Seen at, float depth) {
  return part == kBehind ? depth > at.surface && depth < at.scene : depth <= min(at.surface, at.scene);
}

// Lays the panes of the triangles in hand over each other.
void add_panes(int part, int from, inout Seen at[kPixels]) {
  for (int word = 0; word < 8; ++word) {
    for (uint left = at_hand(word); left != 0u; left &= left - 1u) {
      int place = 32 * word + findLSB(left);
      uint blocks = blocks_touched(place);
      Facet facet = facets[place];
      int index = triangle_at(from, place);
      for (int k = 0; k < kPixels; ++k) {
        Hit hit;
        if ((blocks >> 2 * k & 1u) == 0u || !meets(facet, at[k].ray, hit) || !lies_there(part, at[k], hit.depth)) continue;
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
  bool any_behind = false;
  for (int k = 0; k < kPixels; ++k) {
    ivec2 texel = min(texel_of(k), ivec2(picture.xy) - 1);
    // A pane that stands on something lies at its depth: it is seen, by all rays alike. Two hundredths of a millimetre
    // at a metre, far beyond what rounding moves either by.
    at[k].scene = 1.00002 * texelFetch(scene_depth, texel, 0).r;
    at[k].surface = has_fluid != 0 ? texelFetch(fluid_depth, texel, 0).r : 1.0e6;
    at[k].ray = ray_of(texel_of(k));
    any_behind = any_behind || at[k].surface < at[k].scene;
  }
  if (gl_LocalInvocationIndex == 0u) any_in_tile = 0;
  barrier();
  if (any_behind) any_in_tile = 1;
  barrier();
  bool in_hand = false;  // all that touches the tile
#ifdef BOTH
  vec3 behind[kPixels];
#endif
  for (int part = kFirst; part <= kLast; ++part) {
    for (int k = 0; k < kPixels; ++k) {
      at[k].added = vec3(0.0);
      at[k].through = vec3(1.0);
      at[k].touched = false;
    }
    int groups_here = part == kBefore || any_in_tile != 0 ? count : 0;
    for (int base = 0; base < groups_here; base += 256) {
      if (!in_hand) look_for_groups(base);
      for (int from = 0; from < found_groups; from += 4) {
        if (!in_hand) look_for(from);
        if (part == kBefore || any_behind) add_panes(part, from, at);
      }
    }
    in_hand = groups_here > 0 && count <= 256 && found_groups <= 4;
    for (int k = 0; k < kPixels; ++k) {
      ivec2 texel = texel_of(k);
      if (any(greaterThanEqual(texel, ivec2(picture.xy)))) continue;
#ifdef BOTH
      if (part == kBefore) {
        if (at[k].surface > kFluidDepthLimit) {
          imageStore(color, texel, vec4(behind[k] * at[k].through + at[k].added, 0.0));
        } else {
          imageStore(pane_added, texel, vec4(at[k].added, 0.0));
          imageStore(pane_through, texel, vec4(at[k].through, 0.0));
        }
        continue;
      }
#elif !defined(BEHIND)
      if (!at[k].touched) continue;
#endif
#ifdef BOTH
      vec4 value = resolved(mesh_color, occlusion, texel);
#else
      vec4 value = imageLoad(color, texel);
#endif
      value = vec4(value.rgb * at[k].through + at[k].added, value.a);
#ifdef BOTH
      behind[k] = value.rgb;
#else
      if (at[k].touched) imageStore(color, texel, value);
#endif
#ifdef BEHIND
      imageStore(scene_color, texel, value);
#endif
    }
  }
}
