// What room a settled particle takes, and what the model counts of it (passes/rest_density/rest_density.h):
// pairs drag by that (tests/notebook/2026-11-25-particle-volume-in-viscous-force.md).
#include "sim/passes/rest_density/rest_density.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/run_constants.h"
#include "sim/saved_state.h"
#include "tests/physics/lab.h"

namespace slosh::lab {
namespace {

constexpr double kPackingSpacing = 0.008;

// The particles of a world, with the volumes that its density pass gave them.
ParticleState particles_of(Experiment& e, const Scene& scene, const RunConstants& constants) {
  SavedState state;
  state.bodies = std::vector<RigidBody>(scene.bodies.size());
  const ParticleStart start = make_particle_start(scene, e.sampled(), constants, state.bodies);
  std::vector<std::uint8_t> bytes;
  EXPECT_TRUE(e.world().save(bytes));
  const auto read = read_state(bytes, state_frame(scene, e.world().plan(), start), constants, state);
  EXPECT_TRUE(read) << read.error().text();
  return std::move(state.particles);
}

struct Volumes {
  double taken;    // m³ a particle, by how many there are
  double counted;  // m³, the mean of what the model has
};

// Far from walls and surface, over boxes moved by less than a spacing each, so that it does not matter how a
// box fits the layers.
Volumes volumes_inside(const ParticleState& p) {
  constexpr int kBoxes = 2000;
  const glm::dvec3 half(0.03, 0.02, 0.03), middle(0.0, 0.08, 0.0);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> move(-kPackingSpacing, kPackingSpacing);
  double count = 0.0, volume = 0.0;
  for (int k = 0; k < kBoxes; ++k) {
    const double x = move(random), y = move(random), z = move(random);
    const glm::dvec3 centre = middle + glm::dvec3(x, y, z);
    for (std::size_t i = 0; i < p.size(); ++i) {
      const glm::dvec3 d = glm::abs(glm::dvec3(p.x[i], p.y[i], p.z[i]) - centre);
      if (d.x >= half.x || d.y >= half.y || d.z >= half.z) continue;
      count += 1.0;
      volume += p.volume[i];
    }
  }
  return {kBoxes * 8.0 * half.x * half.y * half.z / count, volume / count};
}

struct Settled {
  double rest;  // against which settled fluid is measured, over the lattice's
  Volumes volumes;
};

Settled settled_syrup(ParticleModel model) {
  const SceneBuilder b = full_tank(model, 1400.0, 5.0);
  Experiment e(b.scene, kPackingSpacing);
  e.settle(1.0);
  e.run(0.1);
  const RunConstants c = make_run_constants(b.scene, e.sampled(), e.world().plan());
  const float rest = settled(c.correction, c.load_compression, kSettlingTime).rest_number;
  return {rest / c.correction.rest_number, volumes_inside(particles_of(e, b.scene, c))};
}

// Under its own weight it lies as densely as the lattice that it starts from, and against a rest that is
// thinner by 2 % a particle counts less than its room, by as much.
TEST(RestDensity, a_particle_counts_less_than_the_room_that_it_takes) {
  const auto [rest, v] = settled_syrup(ParticleModel::kCorrected);
  ASSERT_NEAR(rest, 0.98, 1e-6);
  const double lattice = std::pow(kPackingSpacing, 3);
  EXPECT_LT(std::abs(report("room of a settled particle", v.taken, lattice, "m3")), 0.01);
  EXPECT_LT(std::abs(report("what is counted of it", v.counted, rest * v.taken, "m3")), 0.01);
}

// Pressure projection has no such rest density.
TEST(RestDensity, where_pressures_are_solved_for_all_of_it_counts) {
  const auto [rest, v] = settled_syrup(ParticleModel::kIncompressible);
  EXPECT_EQ(rest, 1.0);
  EXPECT_LT(std::abs(report("the same, incompressible", v.counted, v.taken, "m3")), 0.01);
}

}  // namespace
}  // namespace slosh::lab
