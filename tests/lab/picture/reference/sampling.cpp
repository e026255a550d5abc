#include "tests/lab/picture/reference/sampling.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace slosh::reference {

glm::vec3 around(const glm::vec3& axis, float cosine, float turn) {
  const glm::vec3 other = std::abs(axis.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  const glm::vec3 u = glm::normalize(glm::cross(other, axis));
  const glm::vec3 v = glm::cross(axis, u);
  const float sine = std::sqrt(std::max(1.0f - cosine * cosine, 0.0f));
  const float angle = glm::two_pi<float>() * turn;
  return axis * cosine + (u * std::cos(angle) + v * std::sin(angle)) * sine;
}

glm::vec3 rough_normal(const glm::vec3& normal, float roughness, Random& random) {
  const float a = roughness * roughness;
  if (a < 1e-4f) return normal;
  const float u = random();
  return around(normal, std::sqrt((1.0f - u) / (1.0f + (a * a - 1.0f) * u)), random());
}

float dielectric(float cosine, float eta) {
  const float sine2 = (1.0f - cosine * cosine) / (eta * eta);
  if (sine2 >= 1.0f) return 1.0f;
  const float inner = std::sqrt(1.0f - sine2);
  const float s = (cosine - eta * inner) / (cosine + eta * inner);
  const float p = (inner - eta * cosine) / (inner + eta * cosine);
  return 0.5f * (s * s + p * p);
}

bool cross_fluid(const Hit& hit, const FluidLook& look, bool freely, glm::vec3& way, Random& random) {
  const bool entering = glm::dot(hit.face, way) < 0.0f;
  glm::vec3 normal = rough_normal(hit.normal, look.roughness, random);
  if (!entering) normal = -normal;
  const float cosine = -glm::dot(normal, way);
  if (cosine <= 0.0f || freely) return true;
  const float eta = entering ? look.refraction : 1.0f / look.refraction;
  const float whole = dielectric(cosine, eta);
  const float mirrored = whole >= 1.0f ? 1.0f : whole * look.gloss;
  if (random() < mirrored) {
    const glm::vec3 to = glm::reflect(way, normal);
    const bool same_side = (glm::dot(hit.face, to) < 0.0f) == !entering;
    if (!same_side) return true;
    way = to;
    return false;
  }
  const glm::vec3 in = glm::refract(way, normal, 1.0f / eta);
  if (glm::dot(in, in) > 0.5f) way = in;
  return true;
}

glm::vec3 pane_tint(const MeshLook& look, float facing) {
  return glm::pow(glm::mix(glm::vec3(1.0f), look.base_color, look.opacity),
                  glm::vec3(1.0f / std::max(facing, 0.25f)));
}

}  // namespace slosh::reference
