// A particle as the light sees it, for points (fluid_shadow.vert) and by atomics (fluid_shadow.comp).
uniform mat4 clip_from_world;
uniform float point_size;     // texels across a splat
uniform vec3 extinction[16];
uniform float weight;         // particles that this one stands for
uniform float chord;          // m through the middle of a splat

// Through the middle, per channel; 1 − depth in the light's view.
vec4 dimming_of(vec4 at, float fluid) {
  return vec4(extinction[int(fluid)] * (weight * chord), clamp(0.5 - 0.5 * at.z, 0.0, 1.0));
}
// The same at a place of the splat, `off` (squared) from its middle, below 1. It has a ball's volume and falls off evenly: by a
// ball's own rim rows of particles along a wall edged the shadow with scallops.
vec4 dimming_at(vec4 through_middle, float off) { return vec4(through_middle.rgb * (1.3333333 * (1.0 - off)), through_middle.a); }
