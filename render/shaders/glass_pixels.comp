// Glass by compute shaders: translucent.frag, all panes of a pixel at once, in the order in which they would be drawn. BEHIND: those
// behind the fluid's surface, and what is seen through it is copied for the fluid.
#include "glass.glsl"
#include "mesh_tiles.glsl"
layout(binding = 0, rgba16f) uniform image2D color;
#ifdef BEHIND
layout(binding = 1) writeonly uniform image2D scene_color;
#endif
layout(binding = 0) uniform sampler2D fluid_depth;
layout(binding = 1) uniform sampler2D scene_depth;
uniform int has_fluid;
shared int any_in_tile;  // of whose pixels something may lie between
void main() {
  float nearest[kPixels];   // between these is what is drawn
  float farthest[kPixels];
  vec2 ray[kPixels];
  vec3 added[kPixels];
  vec3 through[kPixels];
  bool touched[kPixels];
  bool any_between = false;
  for (int k = 0; k < kPixels; ++k) {
    ivec2 texel = min(texel_of(k), ivec2(picture.xy) - 1);
    // A pane that stands on something lies at its depth: it is seen, by all rays alike. Two hundredths of a millimetre
    // at a metre, far beyond what rounding moves either by.
    float scene = 1.00002 * texelFetch(scene_depth, texel, 0).r;
    float surface = has_fluid != 0 ? texelFetch(fluid_depth, texel, 0).r : 1.0e6;
#ifdef BEHIND
    nearest[k] = surface;
    farthest[k] = scene;
#else
    nearest[k] = 0.0;
    farthest[k] = min(scene, surface);
#endif
    ray[k] = ray_of(texel_of(k));
    added[k] = vec3(0.0);
    through[k] = vec3(1.0);
    touched[k] = false;
    any_between = any_between || nearest[k] < farthest[k];
  }
  if (gl_LocalInvocationIndex == 0u) any_in_tile = 0;
  barrier();
  if (any_between) any_in_tile = 1;
  barrier();
  int groups_here = any_in_tile != 0 ? count : 0;
  for (int base = 0; base < groups_here; base += 256) {
    look_for_groups(base);
    for (int from = 0; from < found_groups; from += 4) {
      look_for(from);
      if (!any_between) continue;
      for (int word = 0; word < 8; ++word) {
        for (uint left = at_hand(word); left != 0u; left &= left - 1u) {
          int place = 32 * word + findLSB(left);
          uint blocks = blocks_touched(place);
          Facet facet = facets[place];
          int index = triangle_at(from, place);
          for (int k = 0; k < kPixels; ++k) {
            Hit hit;
            if ((blocks >> 2 * k & 1u) == 0u || !meets(facet, ray[k], hit)) continue;
#ifdef BEHIND
            if (hit.depth <= nearest[k] || hit.depth >= farthest[k]) continue;
#else
            if (hit.depth > farthest[k]) continue;
#endif
            Triangle t = triangles[index];
            Item item = items[int(t.a.w)];
            Pane pane = glass_pane(world_of(ray[k], hit.depth), normal_of(t, hit.weights), item.base, item.surface.y);
            added[k] = added[k] * pane.through + pane.added;
            through[k] *= pane.through;
            touched[k] = true;
          }
        }
      }
    }
  }
  for (int k = 0; k < kPixels; ++k) {
    ivec2 texel = texel_of(k);
    if (any(greaterThanEqual(texel, ivec2(picture.xy)))) continue;
#ifndef BEHIND
    if (!touched[k]) continue;
#endif
    vec4 value = imageLoad(color, texel);
    value = vec4(value.rgb * through[k] + added[k], value.a);
    if (touched[k]) imageStore(color, texel, value);
#ifdef BEHIND
    imageStore(scene_color, texel, value);
#endif
  }
}
