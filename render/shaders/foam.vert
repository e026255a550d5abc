// Foam, spray and bubbles: a point a drop.
#include "frame_block.glsl"
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 look;  // radius m, opacity
out vec3 world;
out float eye_depth;
out float radius;
out float opacity;
void main() {
  vec4 eye = eye_from_world * vec4(position, 1.0);
  world = position;
  eye_depth = -eye.z;
  radius = look.x;
  float pixels = 2.0 * radius * splat.y / max(eye_depth, 1.0e-4);
  // What is smaller than a pixel and a half is fainter instead.
  gl_PointSize = max(pixels, 1.5);
  opacity = look.y * min(pixels * pixels / 2.25, 1.0);
  gl_Position = clip_from_eye * eye;
}
