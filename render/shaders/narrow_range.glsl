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
// them even out (a drop of large particles showed a net of lines), by kMostTaps at most.
const float kWidestStride = 5.0f;
const float kMostTaps = 40.0f;
SHARED float filter_stride(float reach, float taps) { return ceil(reach / clamp(reach / kWidestStride, taps, kMostTaps)); }
