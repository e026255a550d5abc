#include "sim/walls/particle_layer.h"

#include <algorithm>
#include <cmath>

#include "sim/math/kernels.h"
#include "sim/model.h"
#include "sim/passes/pressure_force/pair_pressure.h"
#include "sim/walls/point_buckets.h"

namespace slosh {

LayerParticle moved(const Pose& pose, const LayerParticle& p) {
  const auto place = [&](const glm::vec3& at) { return glm::vec3(transform_point(pose, glm::dvec3(at))); };
  return {place(p.position), place(p.surface), glm::vec3(pose.orientation * glm::dvec3(p.normal)), p.depth,
          p.lacks};
}

namespace {

// Of the cosine between two normals: below it faces are a thin wall's two sides. An edge's are not.
constexpr float kOpposed = -0.5f;
// Of a spacing, off the surface: where the first layer of fluid is to stand (wall_inset.cpp).
constexpr float kFirstLayer = 0.48f;

// What a plane, evenly covered, adds to the density a fixed way within its reach: the kernel's shape over it,
// without its constant. `reach`: spacings.
double plane_density(double within, double reach) {
  return std::pow(within, 4) * (reach / 4.0 - within / 5.0);
}

// What is around a layer's particles.
class ParticleLayer {
 public:
  ParticleLayer(std::span<const LayerParticle> particles, const Plan& plan)
      : particles_(particles),
        spacing_(plan.spacing),
        h_(static_cast<float>(plan.support_radius)),
        near_(h_) {
    for (const LayerParticle& p : particles) near_.add(p.position);
  }

  // The kernel's shape over a flat layer at the spacing, at one of its particles.
  double flat() const {
    double sum = 0.0;
    const int reach = static_cast<int>(std::ceil(h_ / spacing_));
    for (int x = -reach; x <= reach; ++x) {
      for (int y = -reach; y <= reach; ++y)
        sum += spiky_shape<double>(spacing_ * spacing_ * (x * x + y * y), h_);
    }
    return sum;
  }

  // Over the particles of p's own side, at p.
  double own(std::uint32_t p) const {
    double sum = 0.0;
    near_.around(particles_[p].position, [&](const glm::vec3& q, std::uint32_t n) {
      const glm::vec3 d = particles_[p].position - q;
      sum += opposed(p, n) ? 0.0 : spiky_shape<double>(glm::dot(d, d), h_);
    });
    return sum;
  }

  // What is left of p's share where another side is near.
  double behind_thin_wall(std::uint32_t p, std::span<const float> shares) const {
    const LayerParticle& particle = particles_[p];
    const glm::vec3 layer = particle.surface + static_cast<float>(kFirstLayer * spacing_) * particle.normal;
    double own = 0.0, other = 0.0;
    around(layer, [&](std::uint32_t q, double shape) { (opposed(p, q) ? other : own) += shares[q] * shape; });
    if (other == 0.0 || own == 0.0) return 1.0;
    const double ratio = h_ / spacing_, within = ratio - kFirstLayer - particle.depth / spacing_;
    const double meant = plane_density(within, ratio);
    const double found = plane_density(within, ratio - particle.lacks / spacing_);
    return own / (own + other) * meant / found;
  }

 private:
  template <class F>
  void around(const glm::vec3& at, F&& f) const {
    near_.around(at, [&](const glm::vec3& q, std::uint32_t number) {
      const float reach = h_ - particles_[number].lacks;
      f(number, spiky_shape<double>(glm::dot(at - q, at - q), reach));
    });
  }
  bool opposed(std::uint32_t p, std::uint32_t q) const {
    return glm::dot(particles_[p].normal, particles_[q].normal) < kOpposed;
  }

  std::span<const LayerParticle> particles_;
  double spacing_;
  float h_;
  PointBuckets near_;
};

}  // namespace

std::vector<float> layer_shares(std::span<const LayerParticle> particles, const Plan& plan) {
  const ParticleLayer layer(particles, plan);
  const double flat = layer.flat();
  std::vector<float> crowded;
  crowded.reserve(particles.size());
  for (std::uint32_t p = 0; p < particles.size(); ++p)
    crowded.push_back(static_cast<float>(kWallShare * flat / layer.own(p)));
  std::vector<float> shares = crowded;
  for (std::uint32_t p = 0; p < particles.size(); ++p)
    shares[p] *= static_cast<float>(layer.behind_thin_wall(p, crowded));
  return shares;
}

}  // namespace slosh
