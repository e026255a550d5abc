// How each fluid of the frame looks. Mirrors LookBlock in passes/frame_block.cpp.
struct Look {
  vec4 color_displacement;     // F_c, β
  vec4 extinction_scattering;  // F_e 1/m, share that comes back
  vec4 specular_exponent;      // k_s, α
  vec4 surface;                // gloss, refractive index, roughness
};
layout(std140, binding = 1) uniform Looks { Look looks[16]; };
