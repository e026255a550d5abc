// A particle as a sphere whose chords are summed, at a half or a quarter of the picture's size; for points (chord.vert) and by
// atomics (chord.comp).
#include "frame_block.glsl"
#include "shared.glsl"
#include "thickness.glsl"
layout(binding = 0) uniform sampler2D scene_depth;
uniform int pixels;   // of the picture along one of a texel here
uniform vec2 sphere;  // radius of what is drawn and of the particle, m

struct ChordPoint {
  float size;    // texels across
  float weight;  // keeps the particle's volume
};
ChordPoint chord_point(float depth) {
  // A point has a largest size: what is nearer than it allows is drawn smaller and denser.
  float wanted = 2.0 * sphere.x * splat.y / (depth * float(pixels));
  float size = clamp(wanted, 1.0, 256.0);
  float share = sphere.y / sphere.x;
  float drawn = wanted / size;
  return ChordPoint(size, share * share * share * drawn * drawn);
}

// The part of the chord that lies before the scene. disc: −1 to 1 across the point.
float chord_at(ivec2 texel, vec2 disc, float depth, float weight) {
  float scene = texelFetch(scene_depth, min(texel * pixels + pixels / 2, ivec2(picture.xy) - 1), 0).r;
  return weight * chord_before(depth, sphere.x, dot(disc, disc), scene);
}
