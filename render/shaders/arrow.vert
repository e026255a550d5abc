#include "frame_block.glsl"
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 tint;
out vec3 world_normal;
out vec3 world;
out vec3 arrow_tint;
out float eye_depth;
void main() {
  vec4 eye = eye_from_world * vec4(position, 1.0);
  world = position;
  world_normal = normal;
  arrow_tint = tint;
  eye_depth = -eye.z;
  gl_Position = clip_from_eye * eye;
}
