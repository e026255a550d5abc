// Edges made smooth in the picture as shown, by what Lottes found (FXAA, 2009): an edge's two ends say where it crosses the
// pixel, and so how much of the pixel belongs to the other side. Pixels without an edge are copied.
#include "shared.glsl"
#include "edges.glsl"
layout(binding = 0) uniform sampler2D shown;

// By the sampler, which clamps at the picture's edges: a CPU samples eight-bit colours faster than it fetches them.
vec3 color_at(vec2 at) { return textureLod(shown, at / vec2(textureSize(shown, 0)), 0.0).rgb; }
float brightness_at(vec2 at) { return brightness(color_at(at)); }

// Steps from `texel` along the edge to where it ends, and there the mean brightness over the edge less that here.
vec2 edge_end(vec2 texel, vec2 along, vec2 over, float here, float tolerance) {
  vec2 end = vec2(float(kLongestEdge), 0.0);
  for (int k = 1; k <= kLongestEdge; ++k) {
    vec2 at = texel + along * float(k);
    float off = 0.5 * (brightness_at(at) + brightness_at(at + over)) - here;
    if (abs(off) >= tolerance) {
      end = vec2(float(k), off);
      break;
    }
  }
  return end;
}

bool pixel(ivec2 whole_texel, out vec4 value) {
  vec2 texel = vec2(whole_texel) + 0.5;
  vec3 middle = color_at(texel);
  Cross cross_of = Cross(brightness(middle), brightness_at(texel + vec2(0, 1)), brightness_at(texel - vec2(0, 1)),
                         brightness_at(texel + vec2(1, 0)), brightness_at(texel - vec2(1, 0)));
  vec3 seen = middle;
  // A loop that runs once: a CPU's shaders skip loops that no pixel of theirs takes, but not branches.
  int edges = has_edge(cross_of) ? 1 : 0;
  for (int i = 0; i < edges; ++i) {
    Corners corners = Corners(brightness_at(texel + vec2(-1, 1)), brightness_at(texel + vec2(1, 1)),
                              brightness_at(texel + vec2(-1, -1)), brightness_at(texel + vec2(1, -1)));
    bool level = edge_is_level(cross_of, corners);
    float before = level ? cross_of.below : cross_of.left;
    float after = level ? cross_of.above : cross_of.right;
    bool to_before = abs(before - cross_of.middle) >= abs(after - cross_of.middle);
    float other = to_before ? before : after;
    vec2 over = (level ? vec2(0, 1) : vec2(1, 0)) * (to_before ? -1.0 : 1.0);
    vec2 along = level ? vec2(1, 0) : vec2(0, 1);
    float here = 0.5 * (cross_of.middle + other);
    float tolerance = 0.25 * abs(other - cross_of.middle);
    vec2 ahead = edge_end(texel, along, over, here, tolerance);
    vec2 back = edge_end(texel, -along, over, here, tolerance);
    seen = mix(middle, color_at(texel + over), other_share(cross_of, corners, here, ahead, back));
  }
  value = vec4(seen, 1.0);
  return true;
}
#include "pixel_main.glsl"
