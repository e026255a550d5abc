// Thickness of fluid along a line of sight, by summed chords. GLSL and C++; pure functions. Beyond the paper.

// Chord of a sphere about `center_depth`, m, at `off` (squared distance from its middle, radii) that lies before `scene`.
SHARED float chord_before(float center_depth, float radius, float off, float scene) {
  float half_chord = radius * sqrt(max(1.0f - off, 0.0f));
  return clamp(scene - (center_depth - half_chord), 0.0f, 2.0f * half_chord);
}

// From the first surface to the last (`span`) there is fluid throughout, or there are layers with air between: chords of
// all particles sum up to nearly the span, or to less. The span has no noise, so it is taken where they agree.
SHARED float layered_thickness(float span, float chords) {
  float filled = chords / max(span, 1.0e-6f);
  return mix(min(chords, span), span, smoothstep(0.55f, 0.8f, filled));
}
