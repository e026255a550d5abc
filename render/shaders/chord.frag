// The part of a sphere's chord that lies before the scene, added up.
#include "frame_block.glsl"
#include "shared.glsl"
#include "thickness.glsl"
layout(binding = 0) uniform sampler2D scene_depth;
uniform vec2 sphere;
uniform int pixels;
flat in float center_depth;
flat in float weight;
layout(location = 0) out float chord;
void main() {
  vec2 disc = gl_PointCoord * 2.0 - 1.0;
  float scene = texelFetch(scene_depth, min(ivec2(gl_FragCoord.xy) * pixels + pixels / 2, ivec2(picture.xy) - 1), 0).r;
  chord = weight * chord_before(center_depth, sphere.x, dot(disc, disc), scene);
}
