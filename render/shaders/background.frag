#include "environment.glsl"
layout(location = 0) out vec4 color;
void main() {
  vec3 direction = mat3(world_from_eye) * normalize(eye_position(gl_FragCoord.xy, 1.0));
  color = vec4(studio(direction), 0.0);
}
