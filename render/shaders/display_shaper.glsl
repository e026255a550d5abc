// Spreads scene-linear light over the display table's axis as the eye does. GLSL and C++; pure functions.

const float kShaperOffset = 0.02f;
const float kShaperMaximum = 32.0f;  // brighter light is shown as this

// Scene-linear 0–kShaperMaximum → 0–1, logarithmic with a straight start.
SHARED vec3 display_shape(vec3 linear_color) {
  float low = log2(kShaperOffset);
  float span = log2(kShaperMaximum + kShaperOffset) - low;
  vec3 lit = clamp(linear_color, vec3(0.0f), vec3(kShaperMaximum));
  return (log2(lit + kShaperOffset) - low) / span;
}

// The inverse.
SHARED vec3 display_unshape(vec3 coordinate) {
  float low = log2(kShaperOffset);
  float span = log2(kShaperMaximum + kShaperOffset) - low;
  return exp2(coordinate * span + low) - kShaperOffset;
}
