// One step of curvature flow (van der Laan, Green & Sainz 2009, Eqs 3–7): the depth moves by the surface's mean
// curvature. Where the surface ends, its derivatives count as zero, as there.
#include "frame_block.glsl"
#include "shared.glsl"
#include "bilateral.glsl"
layout(binding = 0) uniform sampler2D source;
uniform float time_step;  // share of the longest stable one

float beside(ivec2 texel, ivec2 off, float here) {
  ivec2 at = clamp(texel + off, ivec2(0), ivec2(picture.xy) - 1);
  float d = texelFetch(source, at, 0).r;
  return d < kFluidDepthLimit && abs(d - here) * splat.z < 1.0 ? d : here;
}

bool pixel(ivec2 texel, out vec4 value) {
  float z = texelFetch(source, texel, 0).r;
  value = vec4(z);
  if (z > kFluidDepthLimit) return true;
  float right = beside(texel, ivec2(1, 0), z), left = beside(texel, ivec2(-1, 0), z);
  float up = beside(texel, ivec2(0, 1), z), down = beside(texel, ivec2(0, -1), z);
  float zx = 0.5 * (right - left), zy = 0.5 * (up - down);
  float zxx = right + left - 2.0 * z, zyy = up + down - 2.0 * z;
  float zxy = 0.25 * (beside(texel, ivec2(1, 1), z) + beside(texel, ivec2(-1, -1), z) -
                      beside(texel, ivec2(1, -1), z) - beside(texel, ivec2(-1, 1), z));
  // Metres in the plane at depth 1 that a pixel spans.
  float cx = 2.0 * unproject.x * picture.z, cy = 2.0 * unproject.y * picture.w;
  float d = cy * cy * zx * zx + cx * cx * zy * zy + cx * cx * cy * cy * z * z;
  float dx = 2.0 * (cy * cy * zx * zxx + cx * cx * zy * zxy + cx * cx * cy * cy * z * zx);
  float dy = 2.0 * (cy * cy * zx * zxy + cx * cx * zy * zyy + cx * cx * cy * cy * z * zy);
  float ex = 0.5 * zx * dx - zxx * d;
  float ey = 0.5 * zy * dy - zyy * d;
  float curvature = (cy * ex + cx * ey) / max(pow(d, 1.5), 1.0e-30);  // twice the mean one
  // On a plane that faces the eye this is diffusion with 1/(c z) pixels² a unit of time: at most a quarter is stable.
  value = vec4(z - time_step * 0.25 * min(cx, cy) * z * curvature);
  return true;
}
#include "pixel_main.glsl"
