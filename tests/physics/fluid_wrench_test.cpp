// The fluid's wrench on a held body between two states of the world: what the model says against what a world
// that steps a thousand times a second has.
#include <gtest/gtest.h>

#include "tests/physics/fluid_wrench_kit.h"

namespace slosh::lab {
namespace {

// Stirs at about a hertz and trembles at 5 to 8: 0.2 m/s, 5 m/s².
glm::dvec3 stirring(double t) {
  const double e = std::min(1.0, t / 0.3);
  const double p = 2.0 * kPi;
  return e * glm::dvec3(0.025 * std::sin(p * 1.3 * t) + 0.002 * std::sin(p * 8.0 * t),
                        0.0015 * std::sin(p * 5.0 * t),
                        0.015 * std::sin(p * 0.7 * t) + 0.002 * std::sin(p * 6.0 * t));
}

// A plate of 100 × 100 × 20 mm over 60 mm of fluid.
Scene plate_over(double viscosity) {
  SceneBuilder b;
  b.add_fluid(1000.0, viscosity);
  b.add_volume(make::box({-0.09, 0.0, -0.09}, {0.09, 0.06, 0.09}));
  const int tank = b.add_fixed("tank", tank_at_floor({0.18, 0.14, 0.18}, 0.02));
  const int plate = b.add_free("plate", make::box({-0.05, -0.01, -0.05}, {0.05, 0.01, 0.05}), 0.3,
                               {{0.0, 0.075, 0.0}, {1.0, 0.0, 0.0, 0.0}});
  b.set_viscosity({tank, plate}, kFluidsViscosity);
  b.add_grip(plate, 1000.0, 20.0, 10.0, 0.2);
  b.set_domain({-0.3, -0.1, -0.3}, {0.3, 0.5, 0.3});
  return b.scene;
}

Scene shipped(const std::string& name) {
  return load_scene(find_scene(name).value()).value();
}

TEST(FluidWrench, spoon_in_honey_between_the_states_of_a_host_at_100_hz) {
  const std::vector<Judged> all = judge(spoon_in(2.0), 0.010, stirring, 1.4, 0.5, {0.0, 0.05});
  const Judged& j = all[0];
  tell("spoon in 2 Pa·s, host at 100 Hz", j);
  EXPECT_LE(j.model.share(0), 0.08);
  EXPECT_LE(j.model.share(1), 0.08);
  EXPECT_LE(j.model.tone(0), 0.005);
  EXPECT_GE(j.hold.share(0), 3.0 * j.model.share(0));

  const Judged& away = all[1];
  tell("spoon in 2 Pa·s, host at 100 Hz, 50 ms away", away);
  EXPECT_LE(away.model.share(0), 0.25);
  EXPECT_GE(away.hold.share(0), 4.0 * away.model.share(0));
}

TEST(FluidWrench, spoon_in_water) {
  const Judged j = judge(spoon_in(0.001), 0.010, stirring, 1.4, 0.5).front();
  tell("spoon in water, host at 100 Hz", j);
  EXPECT_LE(j.model.share(0), 0.95 * j.hold.share(0));
}

TEST(FluidWrench, bucket_carried_while_its_water_sloshes) {
  const Path path = [](double t) {
    const double s = std::clamp(t / 0.6, 0.0, 1.0);
    return glm::dvec3(0.15 * s * s * (3.0 - 2.0 * s), 0.02 * std::sin(2.0 * kPi * t), 0.0);
  };
  const Scene scene = shipped("bucket");
  const Judged j = judge(scene, scene.spacing_max, path, 1.2, 0.3).front();
  tell("bucket carried, host at 100 Hz", j);
  EXPECT_LE(j.model.share(0), 0.95 * j.hold.share(0));
}

TEST(FluidWrench, plate_that_bobs_at_the_surface_has_a_waterline) {
  const Path path = [](double t) {
    const double s = std::min(1.0, t);
    const double bob = t > 1.0 ? 0.005 * std::sin(2.0 * kPi * 0.9 * (t - 1.0)) : 0.0;
    return glm::dvec3(0.0, bob - 0.015 * s * s * (3.0 - 2.0 * s), 0.0);
  };
  const Judged j = judge(plate_over(0.1), 0.012, path, 2.4, 1.4, {0.05}).front();
  tell("plate bobbing, host at 100 Hz, 50 ms away", j);
  EXPECT_LE(j.model.share(0), 0.6 * j.hold.share(0));
}

// 80 mm under and 80 mm over the surface, once a second: blows, water that runs off, nothing.
glm::dvec3 in_and_out(double t) {
  return {0.0, 0.045 - 0.08 * std::sin(2.0 * kPi * 0.9 * t + 0.59), 0.0};
}

TEST(FluidWrench, plate_struck_on_the_surface_is_told_no_worse_than_by_the_last_one) {
  const Judged j = judge(plate_over(0.1), 0.012, in_and_out, 1.2, 0.2).front();
  tell("plate in and out, host at 100 Hz", j);
  EXPECT_LE(j.model.share(0), 1.2 * j.hold.share(0));
}

TEST(FluidWrench, ends_where_the_body_leaves_the_fluid) {
  const Scene scene = spoon_in(0.1);
  const auto sampled = sample_scene(scene, 0.010);
  Host host(scene, sampled.value(), 1);
  int wet = 0, dry = 0;
  double least_trust = 1.0;
  while (host.time() < 0.9) {
    host.step(in_and_out);
    const FluidWrenchModel& model = host.models().at(0);
    least_trust = std::min(least_trust, model.trust_radius);
    const bool in_fluid = host.world().drags()[1][0][0] > 0.0;
    (in_fluid ? wet : dry) += 1;
    if (in_fluid) continue;
    EXPECT_EQ(model.wrench.force, glm::dvec3(0.0));
    EXPECT_EQ(model.rate.force, glm::dvec3(0.0));
    EXPECT_EQ(model.d_velocity, Matrix6{});
    EXPECT_EQ(model.d_pose, Matrix6{});
    EXPECT_EQ(model.added_mass, Matrix6{});
  }
  EXPECT_GT(wet, 300);
  EXPECT_GT(dry, 200);
  report_value("ball drawn out, least trust radius", 1e3 * least_trust, "mm");
  EXPECT_LE(least_trust, 0.04) << "no further than the ball is wide";
}

TEST(FluidWrench, a_world_without_fluid_has_no_model) {
  SceneBuilder b;
  b.add_free("brick", make::box({-0.05, -0.02, -0.05}, {0.05, 0.02, 0.05}), 0.5);
  b.add_grip(0, 1000.0, 20.0, 10.0, 0.2);
  const auto sampled = sample_scene(b.scene, 0.01);
  World world(b.scene, sampled.value(), make_plan(b.scene, 0.01), {1, Backend::kCpu});
  FluidModels models(b.scene);
  BodySnapshot now;
  world.step({});
  world.fill(now);
  std::vector<FluidWrenchModel> out(3);
  models.after_step(world, now, std::vector<char>{1}, out);
  EXPECT_TRUE(out.empty());
}

}  // namespace
}  // namespace slosh::lab
