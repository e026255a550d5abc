// Light off and out of a fluid. GLSL and C++; pure functions. Beyond the paper.
//
// A clean liquid's surface mirrors by Fresnel; what is not mirrored goes in, where Beer and Lambert's law takes the scene
// behind away and, in a cloudy fluid, gives light of the fluid's own colour for it.

struct FluidMatter {
  vec3 color;        // of the light that comes back from a deep layer, F_c
  vec3 extinction;   // F_e, 1/m
  float scattering;  // share of the light taken that comes back, 0–1
  float gloss;       // share of a clean surface's reflection, 0–1
  float refraction;  // refractive index, >= 1
  float roughness;   // 0–1, as glTF's
};

struct FluidPoint {
  vec3 normal;      // these three unit, away from the surface
  vec3 to_eye;
  vec3 to_light;
  float thickness;  // m of fluid on the line of sight
};

// Radiances; key: irradiance of the light on what faces it.
struct FluidLight {
  vec3 key;
  vec3 ambient;   // irradiance / π from all round
  vec3 mirrored;  // from where the surface mirrors to
  vec3 behind;    // of the scene, refracted
};

// Reflectance at a right angle, from air.
SHARED float normal_reflectance(float refraction) {
  float r = (refraction - 1.0f) / (refraction + 1.0f);
  return r * r;
}

// Share of the light that is mirrored to the eye: Schlick's, less towards the rim where the surface is rough.
SHARED float fluid_reflectance(FluidMatter m, float cos_eye) {
  float f0 = normal_reflectance(m.refraction);
  return m.gloss * (f0 + max(1.0f - m.roughness - f0, 0.0f) * schlick(0.0f, cos_eye));
}

// How far round its lit side light comes out of a fluid, 0–1: it wanders some 1/F_e, which is much in clear fluid and
// little in batter. `size`: of the fluid's features, m.
SHARED float light_wandering(vec3 extinction, float size) {
  float mean = (extinction.x + extinction.y + extinction.z) / 3.0f;
  return clamp(1.0f / (1.0f + mean * size), 0.2f, 1.0f);
}

// Irradiance / π over that of light straight down, on a surface that light comes out of beyond its lit side; the same in
// sum over a ball for every `wandering`.
SHARED float wrapped_lambert(float cos_light, float wandering) {
  float all = 1.0f + wandering;
  return max(cos_light + wandering, 0.0f) / (all * all);
}

// Shares of diffuse light that a layer sends back and lets through.
struct FluidLayer {
  vec3 back;
  vec3 through;
};

// A layer that scatters, by Kubelka & Munk (1931), with the albedo of which a deep layer gives F_c back: light that is
// scattered much wanders on, so that cloudy fluid must be many 1/F_e deep before it shows its own colour, and the channels
// that it takes least are the last.
SHARED FluidLayer scattering_layer(FluidMatter m, float thickness) {
  vec3 whole = m.color * m.scattering;
  vec3 deep = min(whole, vec3(0.999f));  // at 1 the formula is nought over nought
  vec3 lost = 1.0f - deep * deep;
  vec3 rate = 1.5f * lost / (2.0f * deep + 0.375f * (1.0f - deep) * (1.0f - deep));
  vec3 left = exp(-(thickness * m.extinction * rate));
  vec3 all = 1.0f - deep * deep * left;
  return FluidLayer(whole * (1.0f - left) / all, lost * sqrt(left) / all);
}

// What comes out of the fluid where nothing is mirrored.
SHARED vec3 light_inside(FluidMatter m, FluidPoint p, FluidLight l) {
  vec3 through = transmittance(m.extinction, p.thickness);
  // A layer that is thin for the light's wandering shows the light, not the side it comes from.
  float lit = wrapped_lambert(dot(p.normal, p.to_light), light_wandering(m.extinction, 0.01f));
  FluidLayer layer = scattering_layer(m, p.thickness);
  return layer.back * (l.key * (0.31830989f * lit) + l.ambient) + max(through, layer.through) * l.behind;
}

// The light itself as the surface mirrors it. It is no point: a surface smoother than `kLightSize` shows its size.
const float kLightSize = 0.28f;  // roughness
SHARED vec3 light_glint(FluidMatter m, FluidPoint p, FluidLight l) {
  float n_l = max(dot(p.normal, p.to_light), 0.0f);
  float n_v = max(dot(p.normal, p.to_eye), 1.0e-3f);
  vec3 sum = p.to_light + p.to_eye;
  vec3 half_way = sum / max(length(sum), 1.0e-6f);
  float rough = max(m.roughness, kLightSize);
  float mirrored = fluid_reflectance(m, max(dot(half_way, p.to_eye), 0.0f));
  return l.key * (n_l * mirrored * ggx(max(dot(p.normal, half_way), 0.0f), n_l, n_v, rough));
}

// Radiance towards the eye. `whole`: 0 where the surface's normal is not known well, nothing is mirrored there.
SHARED vec3 fluid_radiance(FluidMatter m, FluidPoint p, FluidLight l, float whole) {
  float mirrored = whole * fluid_reflectance(m, max(dot(p.normal, p.to_eye), 0.0f));
  return mix(light_inside(m, p, l), l.mirrored, mirrored) + whole * light_glint(m, p, l);
}

// Fluids that are mixed, each with its share added up (add_to_mixture); what is in here is sums.
struct FluidMixture {
  FluidMatter sum;
  vec3 color_weight;
  float scattering_weight;
  float share;
};
const float kMixtureDepth = 0.01f;  // m
SHARED FluidMixture no_mixture() {
  FluidMixture none;
  none.sum = FluidMatter(vec3(0.0f), vec3(0.0f), 0.0f, 0.0f, 0.0f, 0.0f);
  none.color_weight = vec3(0.0f);
  none.scattering_weight = 0.0f;
  none.share = 0.0f;
  return none;
}

// What a mixture takes from light is the sum of what its parts take; the colour and the share that comes back are those of what
// takes most of it within a centimetre: a little milk makes water white, batter in chocolate counts as much as chocolate in batter.
SHARED FluidMixture add_to_mixture(FluidMixture mixture, FluidMatter m, float share) {
  vec3 taken = share * (1.0f - exp(-(kMixtureDepth * m.extinction)) + 1.0e-4f);
  float taken_mean = (taken.x + taken.y + taken.z) / 3.0f;
  vec3 back = taken * (m.scattering + 1.0e-4f);
  mixture.sum.color += back * m.color;
  mixture.color_weight += back;
  mixture.sum.scattering += taken_mean * m.scattering;
  mixture.scattering_weight += taken_mean;
  mixture.sum.extinction += share * m.extinction;
  mixture.sum.gloss += share * m.gloss;
  mixture.sum.refraction += share * m.refraction;
  mixture.sum.roughness += share * m.roughness;
  mixture.share += share;
  return mixture;
}

// Of at least one fluid with a share above 0.
SHARED FluidMatter matter_of(FluidMixture mixture) {
  FluidMatter m = mixture.sum;
  float each = 1.0f / mixture.share;
  return FluidMatter(m.color / mixture.color_weight, m.extinction * each, m.scattering / mixture.scattering_weight, m.gloss * each,
                     m.refraction * each, m.roughness * each);
}

// Where light that goes `inside` (unit, eye axes) from `here` leaves a fluid `depth_in` m of depth farther away. A grazing way ends.
SHARED vec3 leaving_place(vec3 here, vec3 inside, float depth_in) { return here + inside * (depth_in / max(-inside.z, 0.25f)); }

// Where the eye sees through a layer of fluid of `depth_in` m along the line of sight's depth, with `depth_behind` m of air
// between it and what is seen: a place in eye axes. The far side is taken to lie along the near one, so that light leaves as
// it came (a slab). here: the point of the surface; way: unit, from the eye; Snell's law.
SHARED vec3 seen_place(vec3 here, vec3 way, vec3 normal, float refraction, float depth_in, float depth_behind) {
  vec3 out_at = leaving_place(here, refract(way, normal, 1.0f / refraction), depth_in);
  return out_at + way * (depth_behind / max(-way.z, 0.25f));
}

// The outer normal (unit, eye axes) of the far side of fluid that is free of bodies, from the near side's and from how the way
// through it grows along the picture's axes, m/m: a ball's is its near side's mirrored, a sheet's its near side's turned round.
const float kSteepest = 3.0f;
SHARED vec3 far_normal(vec3 normal, vec2 growth) {
  vec2 slope = vec2(normal.x, normal.y) / max(normal.z, 0.2f) + growth;
  slope *= min(1.0f, kSteepest / max(length(slope), 1.0e-6f));
  return normalize(vec3(-slope.x, -slope.y, -1.0f));
}

// Where light that comes from inside goes on, unit: out through the far side (`outward`, its normal), or off it where all of it is
// mirrored.
SHARED vec3 leaving_way(vec3 inside, vec3 outward, float refraction) {
  vec3 facing = dot(inside, outward) < 0.0f ? -outward : outward;
  vec3 out_way = refract(inside, -facing, refraction);
  return dot(out_way, out_way) > 0.5f ? out_way : reflect(inside, facing);
}
