// One pass of the narrow-range filter: along an axis, or (CLEAN) over 5 × 5 pixels, which takes the streaks away that two
// axes leave at edges. The first, along rows (FIRST), finds what bodies hide; the last shows it again.
#include "frame_block.glsl"
#include "shared.glsl"
#include "bilateral.glsl"
#include "narrow_range.glsl"
layout(binding = 0) uniform sampler2D source;
#ifdef FIRST
layout(binding = 1) uniform sampler2D scene_depth;
#endif
uniform ivec2 axis;
uniform vec3 kernel;  // reach m, range m, taps a side

#ifdef FIRST
bool hidden(ivec2 texel, float front) { return is_hidden(front, texelFetch(scene_depth, texel, 0).r, splat.x); }
// Negative if a body hides it. What is level with `here` to a splat's radius need not be looked up: it goes on as what is seen does.
float marked(float here, ivec2 texel, float front) {
  return front <= kFluidDepthLimit && abs(front - here) > splat.x && hidden(texel, front) ? -front : front;
}
#endif
#ifdef CLEAN
float fetch(ivec2 at) {
  ivec2 last = ivec2(picture.xy) - 1;
  bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThanEqual(at, last));
  return inside ? texelFetch(source, clamp(at, ivec2(0), last), 0).r : 1.0e6;
}
#endif

bool pixel(ivec2 texel, out vec4 value) {
  float here = texelFetch(source, texel, 0).r;
  value = vec4(here);
  if (here > kFluidDepthLimit) return true;
#ifdef FIRST
  if (hidden(texel, here)) {
    value = vec4(-here);
    return true;
  }
#else
  if (here < 0.0) {
#ifdef CLEAN
    value = vec4(-here);
#endif
    return true;
  }
#endif
#ifdef CLEAN
  float moved = 0.0;
  float weights = 1.0;
  DepthRange range = narrow_range(here, kernel.y);
  for (int y = 0; y <= 2; ++y) {
    for (int x = y == 0 ? 1 : -2; x <= 2; ++x) {
      float a = fetch(texel + ivec2(x, y));
      float b = fetch(texel - ivec2(x, y));
      float w = min(a, b) > 0.0 && in_range(range, a) && in_range(range, b) ? kernel_weight(length(vec2(x, y)) / 3.4) : 0.0;
      moved += w * (clamp(a, -1.0e3, 1.0e3) + clamp(b, -1.0e3, 1.0e3) - 2.0 * here);
      weights += 2.0 * w;
    }
  }
  value = vec4(here + moved / weights);
#else
  ivec2 ends = min(texel, ivec2(picture.xy) - 1 - texel);
  int inside = axis.x != 0 ? ends.x : ends.y;
  float reach = filter_reach(kernel.x * splat.y / here, float(inside));
  int stride = int(filter_stride(reach, kernel.z));
  int taps = inside > 0 ? int(reach) / stride : 0;
  float share = float(stride) / (reach + 1.0);
  DepthRange ahead = narrow_range(here, kernel.y);
  DepthRange behind = ahead;
  LineFit fit = no_neighbours();
  // All of them are in the picture, as the reach ends there.
  ivec2 step_by = axis * stride;
  ivec2 to = texel;
  ivec2 from = texel;
  for (int i = 1; i <= taps; ++i) {
    to += step_by;
    from -= step_by;
    float a = texelFetch(source, to, 0).r;
    float b = texelFetch(source, from, 0).r;
#ifdef FIRST
    a = marked(here, to, a);
    b = marked(here, from, b);
#endif
    bool a_in = a > 0.0 && in_range(ahead, a);
    bool b_in = b > 0.0 && in_range(behind, b);
    float place = float(i) * share;
    float w = kernel_weight(place);
    if (a_in && b_in) fit = with_pair(fit, w, place, off_in_inverse(here, a), off_in_inverse(here, b));
    if (a_in && b < 0.0) fit = with_one(fit, w, place, off_in_inverse(here, a));
    if (b_in && a < 0.0) fit = with_one(fit, w, -place, off_in_inverse(here, b));
    if (a_in) ahead = widened(ahead, a, kernel.y);
    if (b_in) behind = widened(behind, b, kernel.y);
  }
  value = vec4(depth_of_off(here, fitted(fit)));
#endif
  return true;
}
#include "pixel_main.glsl"
