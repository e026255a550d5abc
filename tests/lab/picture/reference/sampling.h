// What paths of light draw by lot, from the eye or from the light.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "render/frame.h"
#include "tests/lab/picture/reference/ray_scene.h"

namespace slosh::reference {

/// PCG (O'Neill 2014).
class Random {
 public:
  Random(std::uint64_t pixel, std::uint64_t sample) : state_((pixel << 20) ^ sample ^ 0x853c49e6748fea9bull) {
    (*this)();
    (*this)();
  }
  /// 0 to less than 1, evenly.
  float operator()() {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    const auto mixed = static_cast<std::uint32_t>(((state_ >> 18) ^ state_) >> 27);
    const auto turn = static_cast<std::uint32_t>(state_ >> 59);
    const std::uint32_t bits = (mixed >> turn) | (mixed << ((32 - turn) & 31));
    return static_cast<float>(bits >> 8) * (1.0f / 16777216.0f);
  }

 private:
  std::uint64_t state_;
};

/// The unit vector at that cosine to `axis`, `turn` (0–1) of a turn round it.
glm::vec3 around(const glm::vec3& axis, float cosine, float turn);
/// A normal of a rough surface, by the GGX distribution.
glm::vec3 rough_normal(const glm::vec3& normal, float roughness, Random& random);
/// Unpolarised reflectance of a smooth surface, light coming at `cosine` from the side that `eta` is relative
/// to.
float dielectric(float cosine, float eta);

/// Light that meets a fluid's surface along `way` is mirrored or goes through, as often as Fresnel's share
/// says; `freely`: it leaves as it is. Returns whether it went through.
bool cross_fluid(const Hit& hit, const FluidLook& look, bool freely, glm::vec3& way, Random& random);

/// What a pane of glass leaves of light that goes through it at that cosine.
glm::vec3 pane_tint(const MeshLook& look, float facing);

}  // namespace slosh::reference
