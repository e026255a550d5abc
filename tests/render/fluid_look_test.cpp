// Light off and out of a fluid (fluid_look.glsl), called as the shader calls it.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>
#include <utility>

#include "render/shader_math.h"

namespace slosh::shader {
namespace {

const vec3 kUp(0.0f, 1.0f, 0.0f);

FluidMatter water() {
  return {vec3(0.1f, 0.35f, 0.55f), vec3(12.0f, 4.0f, 2.5f), 0.2f, 1.0f, 1.33f, 0.05f};
}
FluidMatter milk() {
  return {vec3(0.9f), vec3(400.0f), 1.0f, 1.0f, 1.35f, 0.1f};
}

vec3 slanted(float degrees) {
  const float angle = glm::radians(degrees);
  return {std::sin(angle), std::cos(angle), 0.0f};
}

TEST(FluidLook, ReflectanceIsFresnels) {
  EXPECT_NEAR(normal_reflectance(1.33f), 0.02006f, 1e-5f);
  EXPECT_NEAR(normal_reflectance(1.5f), 0.04f, 1e-6f);
  EXPECT_EQ(normal_reflectance(1.0f), 0.0f);
  FluidMatter m = water();
  m.roughness = 0.0f;
  EXPECT_NEAR(fluid_reflectance(m, 1.0f), 0.02006f, 1e-5f);
  EXPECT_NEAR(fluid_reflectance(m, 0.0f), 1.0f, 1e-5f);
  m.gloss = 0.25f;
  EXPECT_NEAR(fluid_reflectance(m, 0.0f), 0.25f, 1e-5f);
  m.roughness = 1.0f;
  EXPECT_NEAR(fluid_reflectance(m, 0.0f), 0.25f * 0.02006f, 1e-5f) << "no bright rim where it is rough";
}

TEST(FluidLook, WanderingLightIsTheSameInSum) {
  for (const float wandering : {0.0f, 0.2f, 0.6f, 1.0f}) {
    double sum = 0.0;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
      const float cosine = -1.0f + 2.0f * (static_cast<float>(i) + 0.5f) / kSteps;
      sum += wrapped_lambert(cosine, wandering) * 2.0 * glm::pi<double>() * 2.0 / kSteps;
    }
    EXPECT_NEAR(sum, glm::pi<double>(), 1e-3) << wandering;
  }
  EXPECT_GT(light_wandering(water().extinction, 0.01f), 0.9f);
  EXPECT_LT(light_wandering(milk().extinction, 0.01f), 0.25f);
}

TEST(FluidLook, ThinFluidShowsTheSceneAndDeepFluidItsColour) {
  const FluidLight light{vec3(0.0f), vec3(0.5f), vec3(9.0f), vec3(0.3f, 0.2f, 0.1f)};
  const auto inside = [&](const FluidMatter& m, float thickness) {
    return light_inside(m, {kUp, kUp, kUp, thickness}, light);
  };
  EXPECT_EQ(inside(water(), 0.0f), light.behind);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(inside(water(), 100.0f)[c], 0.5f * 0.2f * water().color[c], 1e-6f);
    EXPECT_NEAR(inside(milk(), 100.0f)[c], 0.45f, 1e-6f);
    const float through = std::exp(-0.1f * water().extinction[c]);
    EXPECT_NEAR(inside(water(), 0.1f)[c],
                through * light.behind[c] + 0.5f * scattering_layer(water(), 0.1f).back[c], 1e-6f)
        << "water scatters too little to let more through than goes straight";
  }
  FluidMatter syrup = water();
  syrup.scattering = 0.0f;
  EXPECT_EQ(inside(syrup, 100.0f), vec3(0.0f)) << "what absorbs and does not scatter is black when deep";
}

/// Diffuse light on a layer of some free paths' depth that scatters evenly to all sides: shares that come
/// back and go through.
std::pair<double, double> walked_layer(double back, double depth) {
  // The single-scattering albedo of a deep layer that sends `back` of the light back (Chiang, Kutz & Burley
  // 2016).
  const double albedo =
      1.0 - std::exp(-5.09406 * back + 2.61188 * back * back - 4.31805 * back * back * back);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  constexpr int kPaths = 20000;
  double returned = 0.0;
  double passed = 0.0;
  for (int i = 0; i < kPaths; ++i) {
    double at = 0.0;
    double down = std::sqrt(share(random));
    double weight = 1.0;
    for (int turn = 0; turn < 2000 && weight > 1e-3; ++turn) {
      at -= down * std::log(1.0 - share(random));
      if (at < 0.0 || at > depth) {
        (at < 0.0 ? returned : passed) += weight / kPaths;
        break;
      }
      weight *= albedo;
      down = 2.0 * share(random) - 1.0;
    }
  }
  return {returned, passed};
}

TEST(FluidLook, ACloudyLayerIsAsAWalkThroughItFinds) {
  for (const float back : {0.1f, 0.5f, 0.8f, 0.95f}) {
    for (const float depth : {0.5f, 2.0f, 6.0f}) {
      FluidMatter m = water();
      m.color = vec3(back);
      m.scattering = 1.0f;
      m.extinction = vec3(10.0f);
      const auto [returned, passed] = walked_layer(back, depth);
      const FluidLayer layer = scattering_layer(m, 0.1f * depth);
      EXPECT_NEAR(layer.back.x, returned, 0.03) << back << ", " << depth;
      // Two fluxes of light go twice a layer's depth on their way: what goes straight is taken where it is
      // more.
      EXPECT_NEAR(std::max(layer.through.x, std::exp(-depth)), passed, 0.1) << back << ", " << depth;
      EXPECT_LE(layer.back.x + layer.through.x, 1.0f + 1e-5f);
    }
  }
}

TEST(FluidLook, AWhiteWorldStaysWhite) {
  // Everything round is 1, the fluid takes no light away for good: 1 comes out whatever its surface does.
  FluidMatter m = milk();
  m.color = vec3(1.0f);
  const FluidLight light{vec3(0.0f), vec3(1.0f), vec3(1.0f), vec3(1.0f)};
  for (const float degrees : {0.0f, 30.0f, 60.0f, 85.0f}) {
    for (const float thickness : {0.0f, 0.001f, 0.1f}) {
      const vec3 out = fluid_radiance(m, {kUp, slanted(degrees), kUp, thickness}, light, 1.0f);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(out[c], 1.0f, 2e-3f) << "a layer is reckoned with 0.999 of white at most";
    }
  }
}

TEST(FluidLook, TheGlintTakesNoMoreThanThereIs) {
  // Irradiance of 1 from every direction of the upper half in turn: what is mirrored in all is a reflectance.
  FluidMatter mirror = water();
  mirror.refraction = 1e6f;  // F0 = 1
  for (const float rough : {0.3f, 0.6f, 1.0f}) {
    mirror.roughness = rough;
    double sum = 0.0;
    constexpr int kSteps = 256;
    for (int i = 0; i < kSteps; ++i) {
      for (int k = 0; k < kSteps; ++k) {
        const float cosine = (static_cast<float>(i) + 0.5f) / kSteps;
        const float around = glm::two_pi<float>() * (static_cast<float>(k) + 0.5f) / kSteps;
        const float sine = std::sqrt(1.0f - cosine * cosine);
        const vec3 to_light(sine * std::cos(around), cosine, sine * std::sin(around));
        const FluidLight one{vec3(1.0f), vec3(0.0f), vec3(0.0f), vec3(0.0f)};
        sum += light_glint(mirror, {kUp, slanted(30.0f), to_light, 0.1f}, one).x *
               (glm::two_pi<double>() / (kSteps * kSteps));
      }
    }
    EXPECT_LT(sum, 1.02) << rough;
    EXPECT_GT(sum, rough < 0.5f ? 0.9 : 0.3) << rough;
  }
  EXPECT_EQ(light_glint(water(), {kUp, kUp, -kUp, 0.1f}, {vec3(1.0f), {}, {}, {}}), vec3(0.0f));
}

TEST(FluidLook, ASlabShiftsWhatIsBehindBySnellsLaw) {
  // Looking down −z, the slab's normal turned by an angle: the shift across the line of sight is the
  // textbook's d sin(θ − θ') / cos θ' for a way of d / cos θ' inside.
  const vec3 way(0.0f, 0.0f, -1.0f);
  const vec3 here(0.0f, 0.0f, -1.0f);
  EXPECT_EQ(seen_place(here, way, -way, 1.33f, 0.1f, 0.4f), vec3(0.0f, 0.0f, -1.5f));
  for (const float degrees : {10.0f, 25.0f, 40.0f}) {
    const float turned = glm::radians(degrees);
    const vec3 normal(std::sin(turned), 0.0f, std::cos(turned));
    const float inner = std::asin(std::sin(turned) / 1.49f);
    const vec3 place = seen_place(here, way, normal, 1.49f, 0.1f, 0.4f);
    EXPECT_NEAR(std::abs(place.x), 0.1f * std::tan(turned - inner), 1e-5f) << degrees;
    EXPECT_LT(place.x, 0.0f) << "towards the thicker end, away from the normal's lean";
    EXPECT_NEAR(place.z, -1.5f, 1e-5f);
  }
  EXPECT_EQ(seen_place(here, way, normalize(vec3(0.3f, 0.0f, 1.0f)), 1.0f, 0.1f, 0.0f),
            vec3(0.0f, 0.0f, -1.1f));
}

TEST(FluidLook, ABallsFarSideIsItsNearSidesMirrorImage) {
  for (const float degrees : {0.0f, 20.0f, 45.0f, 65.0f}) {
    const float turned = glm::radians(degrees);
    const vec3 near_side(std::sin(turned), 0.0f, std::cos(turned));
    // Its chord is 2R cos, across it one is R sin off the middle.
    const vec3 far_side = far_normal(near_side, vec2(-2.0f * std::tan(turned), 0.0f));
    EXPECT_NEAR(far_side.x, near_side.x, 1e-5f) << degrees;
    EXPECT_NEAR(far_side.z, -near_side.z, 1e-5f) << degrees;
  }
}

TEST(FluidLook, ThroughASheetLightGoesOnAsItCameThroughAPrismBySnellsLaw) {
  const vec3 way(0.0f, 0.0f, -1.0f);
  const float index = 1.33f;
  for (const float degrees : {0.0f, 20.0f, 45.0f}) {
    const float turned = glm::radians(degrees);
    const vec3 normal(std::sin(turned), 0.0f, std::cos(turned));
    const vec3 inside = refract(way, normal, 1.0f / index);
    const vec3 through_sheet = leaving_way(inside, far_normal(normal, vec2(0.0f)), index);
    EXPECT_NEAR(through_sheet.x, 0.0f, 1e-5f) << degrees;
    EXPECT_NEAR(through_sheet.z, -1.0f, 1e-5f) << degrees;
    // Its far side across the line of sight: it meets that at θ - θ', whose sine grows by the index.
    const float meets = turned - std::asin(std::sin(turned) / index);
    const vec3 through_prism = leaving_way(inside, vec3(0.0f, 0.0f, -1.0f), index);
    EXPECT_NEAR(through_prism.x, -index * std::sin(meets), 1e-5f) << degrees;
  }
  // So flat on the far side that all of it is mirrored there.
  const vec3 flat = glm::normalize(vec3(1.0f, 0.0f, -0.5f));
  const vec3 mirrored = leaving_way(flat, vec3(0.0f, 0.0f, -1.0f), index);
  EXPECT_NEAR(mirrored.x, flat.x, 1e-6f);
  EXPECT_NEAR(mirrored.z, -flat.z, 1e-6f);
}

}  // namespace
}  // namespace slosh::shader
