// A particle as a point over its sphere (chord_point.glsl).
#include "chord_point.glsl"
layout(location = 0) in vec4 particle;  // eye position
flat out float center_depth;
flat out float weight;
void main() {
  gl_Position = clip_from_eye * vec4(particle.xyz, 1.0);
  center_depth = -particle.z;
  ChordPoint point = chord_point(center_depth);
  gl_PointSize = point.size;
  weight = point.weight;
}
