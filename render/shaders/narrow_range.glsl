// Narrow-range filter (Truong & Yuksel 2018). GLSL and C++; pure functions. Depths grow away from the eye.
//
// A neighbour nearer than the range belongs to another surface before this one: it and the one opposite are left out, or
// the rest would pull to one side. A neighbour farther than the range counts as a little behind the range's middle, so
// that an edge is neither smeared nor kept as a step. The range moves along with the surface outwards from the pixel: a
// slope stays one surface however steep.

struct DepthRange {
  float nearest;   // depth below which a neighbour is another surface
  float farthest;  // beyond which it is
};

SHARED DepthRange narrow_range(float depth, float range) { return DepthRange(depth - range, depth + range); }

// The range after it met `depth` inside of it.
SHARED DepthRange widened(DepthRange at, float depth, float range) {
  return DepthRange(min(at.nearest, depth - range), max(at.farthest, depth + range));
}

SHARED bool in_range(DepthRange at, float depth) { return depth >= at.nearest && depth <= at.farthest; }

// Fluid that a body hides is another surface than what is seen: past a ball that swims it is the far side of its hollow, and
// streaks ran down from the ball's foot where it was taken for the water before it. Its depths are negative while the filter works.
// What is hidden but level with what is seen, to a splat's radius, goes on along rows.
SHARED bool is_hidden(float front, float body, float radius) { return front > body + radius; }

// What a pixel's line is smoothed to: of pairs of neighbours, their mean; where bodies hide one of a pair the other counts alone, and
// the line through all of them is drawn, which goes on as they do where a mean would pull to their side. Depths are off the pixel's
// own by their inverse, which goes evenly over a plane in perspective.
struct LineFit {
  float moved;  // sums of weight · depth, weight, and these times place and place squared
  float weights;
  float moved_along;
  float along;
  float squared;
};
SHARED float off_in_inverse(float here, float depth) { return here - here * here / depth; }
SHARED float depth_of_off(float here, float off) { return here / (1.0f - off / here); }
SHARED LineFit no_neighbours() { return LineFit(0.0f, 1.0f, 0.0f, 0.0f, 0.0f); }
SHARED LineFit with_pair(LineFit fit, float weight, float place, float a, float b) {
  float w = weight * place;
  return LineFit(fit.moved + weight * (a + b), fit.weights + 2.0f * weight, fit.moved_along + w * (a - b), fit.along,
                 fit.squared + 2.0f * w * place);
}
SHARED LineFit with_one(LineFit fit, float weight, float place, float a) {
  float w = weight * place;
  return LineFit(fit.moved + weight * a, fit.weights + weight, fit.moved_along + w * a, fit.along + w, fit.squared + w * place);
}
SHARED float fitted(LineFit fit) {
  if (fit.along == 0.0f) return fit.moved / fit.weights;
  return (fit.squared * fit.moved - fit.along * fit.moved_along) / (fit.squared * fit.weights - fit.along * fit.along);
}

// Weight of a neighbour at `share` of the kernel's reach, 0–1: a biweight, close to a Gaussian of 0.38 of the reach and
// without its exponential.
SHARED float kernel_weight(float share) {
  float left = 1.0f - share * share;
  return left * left;
}

// Pixels to a side that a pixel's line is smoothed over, at least 1: its reach, less near the picture's edge, where what would
// be opposite is not seen. inside: pixels from here to that edge.
SHARED float filter_reach(float reach, float inside) { return max(min(reach, inside), 1.0f); }

// How far its taps are apart, pixels: by so many taps, by more where they would be farther apart than the 5 × 5 pixels after
// them even out (a drop of large particles showed a net of lines), by kMaxTaps at most.
const float kWidestStride = 5.0f;
const float kMaxTaps = 40.0f;
SHARED float filter_stride(float reach, float taps) { return ceil(reach / clamp(reach / kWidestStride, taps, kMaxTaps)); }
