// What every pass of a frame knows. Mirrors FrameBlock in passes/frame_block.h.
layout(std140, binding = 0) uniform FrameBlock {
  mat4 eye_from_world;
  mat4 world_from_eye;
  mat4 clip_from_eye;
  mat4 shadow_from_world;  // to the shadow map's texture coordinates and depth, 0–1
  vec4 unproject;          // 1/P00, 1/P11, P20, P21
  vec4 picture;            // width, height, 1/width, 1/height
  vec4 to_light_world;     // unit; w: 1 with a shadow map
  vec4 to_light_eye;       // unit; w: texel of the shadow map in texture coordinates
  vec4 camera;             // position in the world; w: far plane
  vec4 splat;              // radius m, pixels of a metre at one metre, 1/range of the filter, 1/radius in the light's depth
  vec4 key_light;          // irradiance of the light on what faces it; w: m by which shadow look-ups move off a surface
  vec4 sky;                // radiance from above
  vec4 horizon;            // from the side
  vec4 ground;             // from below
  vec4 softbox;            // of the light as seen in reflections
  vec4 switches;           // fresnel, lit fluid, fluid shadow, section 5 as it stands
  vec4 look_switches;      // chords are summed; m of a unit of the shadow map's depth; texels that shadow_reach knows to each side
};

// Eye position of a pixel (gl_FragCoord.xy or texel + 0.5) at a linear eye depth.
vec3 eye_position(vec2 pixel, float depth) {
  vec2 ndc = pixel * picture.zw * 2.0 - 1.0;
  return vec3((ndc + unproject.zw) * unproject.xy * depth, -depth);
}
