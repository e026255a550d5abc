// The fast bilateral filter (paper, section 5.1 and Fig 5). GLSL and C++; pure functions.
//
// Five bilinear samples average 17 depths: the inner S_i, and four outer S_o, each the mean of a 2×2 block.
// The blocks sit round the pixel like a pinwheel, touch it and do not overlap:
//
//     . C C . .
//     . C C A A      A (1.5, 0.5)     C (-0.5, 1.5)
//     D D i A A      D (-1.5, -0.5)   B (0.5, -1.5)
//     D D B B .
//     . . B B .

// Depths above this are no fluid. A 2×2 mean with even one empty pixel (depth 10⁶) is above it.
const float kFluidDepthLimit = 2.0e5f;

const float kInnerWeight = 2.0f;
const float kOuterWeight = 4.0f;

// Centre of outer block k (0–3), pixels from the centre pixel.
SHARED vec2 bilateral_offset(int k) {
  vec2 a = k < 2 ? vec2(1.5f, 0.5f) : vec2(-1.5f, -0.5f);
  return (k == 0 || k == 2) ? a : vec2(-a.y, a.x);
}

// Weight of an outer sample: 4 if its depth is S_i's, falling with the difference to 0 at the range (a biweight, the
// paper names no function). A sample that is not all fluid is far outside the range, so it weighs 0.
// inverse_range: 1/m, one over the difference in depth that no longer counts as the same surface.
SHARED float bilateral_weight(float outer, float inner, float inverse_range) {
  float x = (outer - inner) * inverse_range;
  float near = max(1.0f - x * x, 0.0f);
  return kOuterWeight * near * near;
}

// The filtered depth of one pixel that is fluid. outer: S_o of the four blocks.
SHARED float bilateral_depth(float inner, vec4 outer, float inverse_range) {
  float w0 = bilateral_weight(outer.x, inner, inverse_range);
  float w1 = bilateral_weight(outer.y, inner, inverse_range);
  float w2 = bilateral_weight(outer.z, inner, inverse_range);
  float w3 = bilateral_weight(outer.w, inner, inverse_range);
  // Relative to S_i: an excluded 10⁶ with weight 0 must not cost precision.
  float moved = w0 * min(outer.x - inner, 1.0e3f) + w1 * min(outer.y - inner, 1.0e3f) +
                w2 * min(outer.z - inner, 1.0e3f) + w3 * min(outer.w - inner, 1.0e3f);
  return inner + moved / (kInnerWeight + w0 + w1 + w2 + w3);
}
