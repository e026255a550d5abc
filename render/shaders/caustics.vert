// Light that the fluid's surface sends on to what lies below, as the picture shows both: a point for each second pixel of the surface
// along each side, where its refracted light lands, and another where it would land through a level surface. Beyond the paper.
#include "frame_block.glsl"
#include "shared.glsl"
layout(binding = 1) uniform sampler2D scene_depth;
#include "fluid_normal.glsl"
layout(binding = 0) uniform sampler2D smooth_depth;
uniform ivec2 size;        // of the sums, texels
uniform float refraction;  // index
flat out vec2 flux;        // through the surface as it is; through a level one

vec2 clip_of(vec3 eye) { return eye.xy / (unproject.xy * -eye.z) - unproject.zw; }
float scene_at(vec2 pixel) { return texelFetch(scene_depth, clamp(ivec2(pixel), ivec2(0), ivec2(picture.xy) - 1), 0).r; }

void main() {
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = 5.0;
  flux = vec2(0.0);
  int index = gl_VertexID / 2;
  bool level = gl_VertexID % 2 == 1;
  ivec2 texel = min(2 * ivec2(index % size.x, index / size.x), ivec2(picture.xy) - 1);
  float depth = texelFetch(smooth_depth, texel, 0).r;
  if (depth > kFluidDepthLimit) return;
  vec3 here = eye_position(vec2(texel) + 0.5, depth);
  FluidSurface surface = fluid_surface(smooth_depth, here, texel);
  vec3 to_light = to_light_eye.xyz;
  float lit = dot(surface.normal, to_light);
  float seen = dot(surface.normal, -normalize(here));
  vec3 up = eye_from_world[1].xyz;
  if (surface.whole < 0.5 || lit <= 0.0 || seen < 0.05 || dot(up, to_light) <= 0.0) return;
  vec3 way = refract(-to_light, level ? up : surface.normal, 1.0 / refraction);
  // Where it lands: from the picture's depths, each look nearer than the one before where what lies below is smooth.
  float far = max(scene_at(vec2(texel)) - depth, 0.0);
  vec3 at = here;
  for (int i = 0; i < 6; ++i) {
    at = here + way * far;
    if (at.z > -1.0e-3) return;
    vec2 pixel = (clip_of(at) * 0.5 + 0.5) * picture.xy;
    far = max(dot(eye_position(pixel, min(scene_at(pixel), camera.w)) - here, way), 0.0);
  }
  vec2 clip = clip_of(at);
  if (any(greaterThan(abs(clip), vec2(1.0))) || abs(scene_at((clip * 0.5 + 0.5) * picture.xy) + at.z) > -0.01 * at.z) return;
  gl_Position = vec4(clip, 0.0, 1.0);
  // Of the light that comes down on the surface that the pixel shows.
  float share = depth * depth * lit / seen;
  flux = level ? vec2(0.0, share) : vec2(share, 0.0);
}
