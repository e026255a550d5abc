#include "frame_block.glsl"
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
#ifdef TEXTURED
layout(location = 2) in vec2 at_texture;
out vec2 texcoord;
#endif
uniform mat4 model;
out vec3 world;
out vec3 world_normal;
out float eye_depth;
void main() {
  vec4 at = model * vec4(position, 1.0);
  vec4 eye = eye_from_world * at;
#ifdef TEXTURED
  texcoord = at_texture;
#endif
  world = at.xyz;
  world_normal = mat3(model) * normal;
  eye_depth = -eye.z;
  gl_Position = clip_from_eye * eye;
}
