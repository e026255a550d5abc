// A particle as the light sees it.
layout(location = 0) in vec4 particle;  // world position; the fluid's index
uniform mat4 clip_from_world;
uniform float point_size;  // texels across a splat
uniform vec3 extinction[16];
uniform float weight;      // particles that this one stands for
uniform float chord;       // m through the middle of a splat
out vec4 optical;          // through the middle, per channel; 1 − depth in the light's view
void main() {
  gl_Position = clip_from_world * vec4(particle.xyz, 1.0);
  gl_PointSize = point_size;
  optical = vec4(extinction[int(particle.w)] * (weight * chord), clamp(0.5 - 0.5 * gl_Position.z, 0.0, 1.0));
}
