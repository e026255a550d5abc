// A particle as a sphere whose chords are summed (chord.frag), at a half or a quarter of the picture's size.
#include "frame_block.glsl"
layout(location = 0) in vec4 particle;  // eye position
uniform int pixels;                     // of the picture along one of a texel here
uniform vec2 sphere;                    // radius of what is drawn and of the particle, m
flat out float center_depth;
flat out float weight;                  // keeps the particle's volume
void main() {
  gl_Position = clip_from_eye * vec4(particle.xyz, 1.0);
  center_depth = -particle.z;
  // A point has a largest size: what is nearer than it allows is drawn smaller and denser.
  float wanted = 2.0 * sphere.x * splat.y / (center_depth * float(pixels));
  gl_PointSize = clamp(wanted, 1.0, 256.0);
  float share = sphere.y / sphere.x;
  float drawn = wanted / gl_PointSize;
  weight = share * share * share * drawn * drawn;
}
