#include "sim/passes/pressure_force/pair_force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <random>

#include "sim/passes/density/corrected_state.h"
#include "sim/pressure/wall_layers.h"

namespace slosh {
namespace {

constexpr double kSupport = 0.02;
constexpr DragShape<double> kLaplacian{1.0, 0.0};

using View = ParticleView<double>;

View random_particle(std::mt19937& random) {
  std::uniform_real_distribution<double> place(0.0, 0.012), speed(-1.0, 1.0), positive(0.5, 2.0);
  return {place(random),
          place(random),
          place(random),
          speed(random),
          speed(random),
          speed(random),
          positive(random),
          1e-6 * positive(random),
          positive(random),
          {positive(random), speed(random), speed(random), positive(random), speed(random), positive(random)},
          speed(random),
          speed(random),
          speed(random)};
}

template <PairRule rule>
glm::dvec3 force(const View& p, const View& i) {
  ForceSum<double> sum{0.0, 0.0, 0.0};
  constexpr DragRule kDrag = rule == PairRule::kPaper ? DragRule::kAlongVelocity : DragRule::kCentral;
  add_pair_force<Spiky, rule, kDrag, true>(p, i, kSupport, kLaplacian, 1.0, sum);
  return {sum.x, sum.y, sum.z};
}

glm::dvec3 position(const View& p) {
  return {p.x, p.y, p.z};
}

template <PairRule rule>
void expect_antisymmetric() {
  std::mt19937 random(11);
  for (int repeat = 0; repeat < 1000; ++repeat) {
    const View a = random_particle(random);
    const View b = random_particle(random);
    const glm::dvec3 ab = force<rule>(a, b);
    const glm::dvec3 ba = force<rule>(b, a);
    EXPECT_LE(glm::length(ab + ba), 1e-14 * glm::length(ab));
  }
}

TEST(PairForce, ConservesMomentum) {
  expect_antisymmetric<PairRule::kPaper>();
  expect_antisymmetric<PairRule::kCorrected>();
}

// Of a fluid and a wall particle each pass sees its own side; both must see the same force.
TEST(PairForce, FluidAndBodyOfTheCorrectedModelPressAlike) {
  std::mt19937 random(14);
  for (int repeat = 0; repeat < 1000; ++repeat) {
    const View fluid = random_particle(random);
    const View wall = random_particle(random);
    const glm::dvec3 on_fluid = force<PairRule::kCorrectedWall>(fluid, wall);
    const glm::dvec3 on_wall = force<PairRule::kCorrectedBody>(wall, fluid);
    EXPECT_LE(glm::length(on_fluid + on_wall), 1e-14 * glm::length(on_fluid));
  }
}

// What the correction is for: a particle among uneven neighbours at its own pressure pushes alike in all
// directions. With the energy's gradient the same neighbours give a shear of some tenths of the pressure.
TEST(PairForce, TheCorrectedVirialIsThePressureWhateverTheNeighbours) {
  std::mt19937 random(15);
  std::uniform_real_distribution<double> jitter(-0.25, 0.25);
  constexpr double kSpacing = 0.5 * kSupport;
  Symmetric<double> rest{};
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z) {
        const double r2 = kSpacing * kSpacing * (x * x + y * y + z * z);
        add_moment(kSpacing * x, kSpacing * y, kSpacing * z, Spiky::pair(r2, kSupport, 1.0), rest);
      }
  double worst_corrected = 0.0, worst_plain = 0.0;
  for (int repeat = 0; repeat < 200; ++repeat) {
    // A sheared and jittered lattice: 20 % longer one way, shorter the others.
    Symmetric<double> moment{};
    for (int x = -3; x <= 3; ++x)
      for (int y = -3; y <= 3; ++y)
        for (int z = -3; z <= 3; ++z) {
          if (x == 0 && y == 0 && z == 0) continue;
          const glm::dvec3 d = kSpacing * glm::dvec3((x + jitter(random)) * 1.2, (y + jitter(random)) / 1.2,
                                                     z + jitter(random));
          add_moment(d.x, d.y, d.z, Spiky::pair(glm::dot(d, d), kSupport, 1.0), moment);
        }
    const double scale = 3.0 / trace(rest);
    const Symmetric<float> of_rest{
        static_cast<float>(scale * moment.xx), static_cast<float>(scale * moment.xy),
        static_cast<float>(scale * moment.xz), static_cast<float>(scale * moment.yy),
        static_cast<float>(scale * moment.yz), static_cast<float>(scale * moment.zz)};
    if (trace(of_rest) < 3.0f) continue;  // as at a surface: not all of it is corrected
    const Symmetric<float> t = pressure_directions(of_rest, 1.0f, 1.0f);
    // The virial of T over the neighbours, T · M, and of the pressure alone, M; both in units of the
    // pressure.
    const double xy = t.xx * of_rest.xy + t.xy * of_rest.yy + t.xz * of_rest.yz;
    const double xx = t.xx * of_rest.xx + t.xy * of_rest.xy + t.xz * of_rest.xz;
    const double yy = t.xy * of_rest.xy + t.yy * of_rest.yy + t.yz * of_rest.yz;
    worst_corrected = std::max({worst_corrected, std::abs(xy), std::abs(xx - yy), std::abs(xx - 1.0)});
    worst_plain = std::max({worst_plain, static_cast<double>(std::abs(of_rest.xy)),
                            static_cast<double>(std::abs(of_rest.xx - of_rest.yy))});
  }
  EXPECT_LT(worst_corrected, 1e-5);
  EXPECT_GT(worst_plain, 0.2);
}

// A particle over a wall, among fluid and wall particles at random: it exerts no net torque on all of them,
// though a wall counts in its moment as one layer, or 1.1, and is pressed on as more.
TEST(PairForce, FluidAtAWallExertsNoTorque) {
  std::mt19937 random(16);
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  constexpr double kSpacing = 0.5 * kSupport;
  double worst = 0.0, worst_without = 0.0;
  for (int repeat = 0; repeat < 100; ++repeat) {
    const double layer = repeat % 2 == 0 ? 1.0 : 1.1;
    std::vector<glm::dvec3> fluids, walls;
    for (int x = -2; x <= 2; ++x)
      for (int y = -2; y <= 2; ++y)
        for (int z = -1; z <= 2; ++z) {
          if (x == 0 && y == 0 && z == 0) continue;
          const glm::dvec3 at(x + jitter(random), y + jitter(random), z);
          if (z < 0)
            walls.push_back(kSpacing * (at - glm::dvec3(0.0, 0.0, 0.2)));
          else
            fluids.push_back(kSpacing * (at + glm::dvec3(0.0, 0.0, jitter(random))));
        }
    Neighborhood<double> sum{};
    double rest = 0.0;
    for (int x = -2; x <= 2; ++x)
      for (int y = -2; y <= 2; ++y)
        for (int z = -2; z <= 2; ++z) {
          const double r2 = kSpacing * kSpacing * (x * x + y * y + z * z);
          rest += kSpacing * kSpacing * x * x * Spiky::pair(r2, kSupport, 1.0).slope_over_r;
        }
    for (const glm::dvec3& at : fluids)
      add_fluid_neighbor<Spiky>(-at.x, -at.y, -at.z, 0.0, 0.0, 0.0, kSupport, 1.0, sum);
    for (const glm::dvec3& at : walls)
      add_wall_neighbor<Spiky>(-at.x, -at.y, -at.z, 2.0, layer, kSupport, 1.0, sum);
    const auto share = [&](double sum_of) { return static_cast<float>(sum_of / rest); };
    const Symmetric<double>& m = sum.moment;
    const Symmetric<float> push = pressure_directions(
        {share(m.xx), share(m.xy), share(m.xz), share(m.yy), share(m.yz), share(m.zz)}, 1.0f, 1.3f);
    View self{};
    self.push = {push.xx, push.xy, push.xz, push.yy, push.yz, push.zz};
    glm::dvec3 torque(0.0), couple(0.0);
    double size = 0.0;
    const auto place = [](const glm::dvec3& at) {
      View other{};
      other.x = at.x, other.y = at.y, other.z = at.z;
      return other;
    };
    for (const glm::dvec3& at : fluids) {
      const glm::dvec3 turned = glm::cross(at, force<PairRule::kCorrected>(place(at), self));
      torque += turned;
      size += glm::length(turned);
    }
    for (const glm::dvec3& at : walls) {
      View wall = place(at);
      wall.pressure = 2.0;
      SurfaceSum<double> on_wall{{0.0, 0.0, 0.0}, 0.0, 0.0, 0.0, 1.0 - layer / 2.0};
      add_pair_force<Spiky, PairRule::kCorrectedBody, DragRule::kCentral, true>(wall, self, kSupport,
                                                                                kLaplacian, 1.0, on_wall);
      const glm::dvec3 turned = glm::cross(at, {on_wall.x, on_wall.y, on_wall.z});
      torque += turned;
      couple += glm::dvec3(on_wall.cx, on_wall.cy, on_wall.cz);
      size += glm::length(turned);
    }
    worst = std::max(worst, glm::length(torque + couple) / size);
    worst_without = std::max(worst_without, glm::length(torque) / size);
  }
  EXPECT_LT(worst, 1e-6);
  EXPECT_GT(worst_without, 0.01);
}

TEST(PairForce, NothingIsCorrectedInAnImpactOrInSpray) {
  const Symmetric<float> uneven{1.4f, 0.2f, 0.0f, 0.9f, 0.1f, 0.8f};
  const Symmetric<float> struck = pressure_directions(uneven, corrected_share(kImpact), 1.3f);
  EXPECT_EQ(struck.xx, 1.0f);
  EXPECT_EQ(struck.xy, 0.0f);
  const Symmetric<float> alone = pressure_directions({0, 0, 0, 0, 0, 0}, corrected_share(0.0f), 1.3f);
  EXPECT_EQ(alone.xx, 1.0f);
  EXPECT_EQ(alone.yz, 0.0f);
  // A neighbourhood without depth has no inverse.
  const Symmetric<float> flat = pressure_directions({1.5f, 0, 0, 1.5f, 0, 0}, corrected_share(0.0f), 1.3f);
  EXPECT_TRUE(std::isfinite(flat.zz));
  EXPECT_LT(flat.zz, 20.0f);
}

// Who has nine tenths of the settled moment is whole where the fluid needs no artificial viscosity, and in
// part a surface where it needs it; who has none is a surface everywhere.
TEST(PairForce, AViscousFluidIsWholeFromNineTenthsOn) {
  CorrectionConstants c;
  c.artificial_viscosity = 0.6f;
  EXPECT_EQ(whole_from(c, 0.001f), 1.0f) << "thin fluid as ever, bitwise";
  EXPECT_EQ(whole_from(c, 0.6f * 0.75f), 1.0f);
  EXPECT_NEAR(whole_from(c, 0.6f), 0.95f, 1e-6f);
  EXPECT_FLOAT_EQ(whole_from(c, 1.0f), 0.9f);
  EXPECT_FLOAT_EQ(whole_from(c, 1000.0f), 0.9f);
  const Symmetric<float> nine_tenths{0.9f, 0.0f, 0.0f, 0.9f, 0.0f, 0.9f};
  const auto along = [&](float whole) { return pressure_directions(nine_tenths, 1.0f, 1.0f, whole).xx; };
  EXPECT_NEAR(along(0.9f), 1.0f / 0.9f, 1e-6f) << "L, all of it";
  EXPECT_NEAR(along(1.0f), 1.0f, 1e-6f) << "0.1 is missing and taken to lie evenly";
  EXPECT_FLOAT_EQ(pressure_directions({0, 0, 0, 0, 0, 0}, 1.0f, 1.3f, 0.9f).xx, 1.0f);
}

// A wall's particle counts in the moment of thin fluid as exactly half of what it presses with, and in that
// of fluid that needs no artificial viscosity as a tenth more, the more the wider the support.
TEST(PairForce, AWallIsMoreThanALayerToThickFluid) {
  for (const double ratio : {1.5, 2.0, 2.6}) {
    EXPECT_EQ(wall_layer(0.6f, 0.0f, ratio), 0.5f);
    EXPECT_EQ(wall_layer(0.6f, 0.6f * 0.75f, ratio), 0.5f);
  }
  EXPECT_NEAR(wall_layer(0.6f, 0.6f, 2.0), 0.525f, 1e-6f);
  EXPECT_FLOAT_EQ(wall_layer(0.6f, 1.0f, 2.0), 0.55f);
  EXPECT_FLOAT_EQ(wall_layer(0.6f, 1000.0f, 2.0), 0.55f);
  EXPECT_FLOAT_EQ(wall_layer(0.6f, 1000.0f, 2.5), 0.585f);
  EXPECT_EQ(thick_layers(2.0), 1.1);
  EXPECT_NEAR(thick_layers(2.125), 1.115, 1e-12) << "halfway between two that were read";
  EXPECT_EQ(thick_layers(1.0), thick_layers(1.5));
  EXPECT_EQ(thick_layers(3.0), thick_layers(2.6));
  EXPECT_EQ(CorrectionConstants{}.wall_layer, 0.5f);
}

// The drag of noise sees no flow that neighbours share, and nothing where there is no neighbour.
TEST(Noise, IsWhatAParticleDoesNotShareWithItsNeighbours) {
  Neighborhood<float> n{};
  n.fluid_number = 4.0f;  // itself 1, others 3
  n.vx = 4.0f * 0.5f;
  float u[3] = {0.0f, 0.0f, 0.0f};
  const float shared[3] = {0.5f, 0.0f, 0.0f};
  add_fluctuation(n, 1.0f, 2.0f, shared, u);
  EXPECT_FLOAT_EQ(u[0], 0.0f);
  // At 2 m/s among three that stand still: the whole of it, times the factor.
  n.vx = 2.0f;
  const float own[3] = {2.0f, 0.0f, 0.0f};
  add_fluctuation(n, 1.0f, 2.0f, own, u);
  EXPECT_FLOAT_EQ(u[0], 4.0f);
  n.fluid_number = 1.0f;
  float alone[3] = {0.0f, 0.0f, 0.0f};
  add_fluctuation(n, 1.0f, 2.0f, own, alone);
  EXPECT_EQ(alone[0], 0.0f);
}

// In an impact artificial viscosity grows, up to what the step bears; in slower fluid it is bitwise
// identical.
TEST(Noise, GrowsWithTheSpeedOfAnImpactUpToWhatTheStepHolds) {
  constexpr float kArtificial = 0.8f, kSound = 5.0f, kMax = 6.0f;
  constexpr auto kGrowth = static_cast<float>(kImpactGrowth) / kSound;
  const auto at = [&](float speed, float viscosity) {
    return artificial_viscosity_in_impact(kArtificial, kArtificial, kGrowth, speed, viscosity, kMax);
  };
  EXPECT_EQ(at(0.0f, 0.0f), kArtificial);
  EXPECT_EQ(at(0.99f * static_cast<float>(kImpactSpeed) * kSound, 0.0f), kArtificial);
  // A tenth of the speed of sound is 0.05 beyond: 50 · 0.05 times as much more.
  EXPECT_FLOAT_EQ(at(0.1f * kSound, 0.0f), kArtificial * 3.5f);
  EXPECT_FLOAT_EQ(at(kSound, 0.0f), kMax);
  EXPECT_FLOAT_EQ(at(kSound, 2.0f), kMax - 2.0f);
  // Where the fluid's own viscosity is all that the step bears, it is what it would be without an impact.
  EXPECT_EQ(at(kSound, kMax), kArtificial);
  // Thick fluid, which has none or less without an impact, gains as much as thin.
  for (const float calm : {0.0f, 0.3f}) {
    EXPECT_EQ(artificial_viscosity_in_impact(calm, kArtificial, kGrowth, 0.04f * kSound, 1.0f, kMax), calm);
    EXPECT_FLOAT_EQ(artificial_viscosity_in_impact(calm, kArtificial, kGrowth, 0.1f * kSound, 1.0f, kMax),
                    calm + kArtificial * 2.5f);
  }
}

TEST(PairForce, CentralDragConservesAngularMomentum) {
  std::mt19937 random(12);
  for (int repeat = 0; repeat < 1000; ++repeat) {
    const View a = random_particle(random);
    const View b = random_particle(random);
    const glm::dvec3 f = force<PairRule::kSolved>(a, b);
    const glm::dvec3 d = position(a) - position(b);
    EXPECT_LE(glm::length(glm::cross(d, f)), 1e-12 * glm::length(d) * glm::length(f));
  }
}

TEST(PairForce, EquationNineMatchesTheFormula) {
  View p{0, 0, 0, 0.1, 0.2, 0.3, 100.0, 1e-6, 2.0, {}, 0, 0, 0};
  View i{0.01, 0, 0, -0.1, 0.5, 0.3, 300.0, 2e-6, 40.0, {}, 0, 0, 0};
  const double constant = 45.0 / (3.14159265358979323846 * std::pow(kSupport, 6));
  const glm::dvec3 f = constant * force<PairRule::kPaper>(p, i);
  // Eq 5: −V_p V_i (P_p + P_i)/2 ∇W; Eq 9: V_p V_i (μ_p + μ_i)/2 (v_i − v_p) ∇²W.
  const double pressure = -1e-6 * 2e-6 * 200.0 * constant * 0.01 * 0.01;  // p is pushed away from i, to −x
  const double viscosity = 1e-6 * 2e-6 * 21.0 * constant * 0.01;
  EXPECT_NEAR(f.x, pressure + viscosity * -0.2, 1e-9 * std::abs(pressure));
  EXPECT_NEAR(f.y, viscosity * 0.3, 1e-9 * std::abs(viscosity));
  EXPECT_NEAR(f.z, 0.0, 1e-15);
}

// In a linear velocity field the two viscosities are the same on average over directions (the factor 5).
TEST(PairForce, CentralDragHasTheViscosityOfEquationNine) {
  std::mt19937 random(13);
  std::normal_distribution<double> normal;
  glm::dvec3 paper(0.0), central(0.0);
  // u_x = y² has Laplacian (2, 0, 0): both sums over a shell must give the same force.
  for (int repeat = 0; repeat < 200000; ++repeat) {
    const glm::dvec3 d = 0.01 * glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    const View p{0, 0, 0, 0, 0, 0, 0.0, 1e-6, 1.0, {}, 0, 0, 0};
    const View i{d.x, d.y, d.z, d.y * d.y, 0, 0, 0.0, 1e-6, 1.0, {}, 0, 0, 0};
    paper += force<PairRule::kPaper>(p, i);
    central += force<PairRule::kSolved>(p, i);
  }
  EXPECT_NEAR(central.x / paper.x, 1.0, 0.02);
}

TEST(PairForce, CoincidentParticlesAndSelfAddNothing) {
  const View p{0.1, 0.2, 0.3, 0.5, 0.5, 0.5, 1000.0, 1e-6, 1.0, {1, 0, 0, 1, 0, 1}, 1, 1, 1};
  EXPECT_EQ(glm::length(force<PairRule::kPaper>(p, p)), 0.0);
  EXPECT_EQ(glm::length(force<PairRule::kCorrected>(p, p)), 0.0);
}

}  // namespace
}  // namespace slosh
