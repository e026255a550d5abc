#include "frame_block.glsl"
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 model;
out vec3 world;
out vec3 world_normal;
out float eye_depth;
void main() {
  vec4 at = model * vec4(position, 1.0);
  vec4 eye = eye_from_world * at;
  world = at.xyz;
  world_normal = mat3(model) * normal;
  eye_depth = -eye.z;
  gl_Position = clip_from_eye * eye;
}
