// The same worlds on the CPU and on the GPU (tests/cross/README.md). Prints every comparison with its
// tolerance; exits 1 when one fails, 77 where there is no GPU. Usage: cross_world
// [viscous|pressed|slipping|warm|quick]: implicit viscosity alone, or pressure projection, or all but these,
// or single steps of each
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <thread>

#include "tests/cross/compare.h"
#include "tests/lab/report/surface.h"

namespace {

using namespace slosh;
using namespace slosh::testing;

void compare_changed() {
  std::printf("viscosities and gravity changed while it runs\n");
  const Tank tank = shaken(stirred_tank(ParticleModel::kCorrected));
  World cpu = world_on(Backend::kCpu, tank);
  World gpu = world_on(Backend::kCuda, tank);
  step(cpu, 0.09);
  step(gpu, 0.09);
  for (World* world : {&cpu, &gpu}) {
    expect_true("a viscosity for each fluid", world->set_viscosity(0, 0.02) && world->set_viscosity(1, 0.03));
    expect_true("half the gravity", static_cast<bool>(world->set_gravity_scale(0.5)));
  }
  for (int i = 0; i < 3; ++i) {
    step(cpu, 0.09);
    step(gpu, 0.09);
  }
  compare_worlds(cpu, gpu, 1e-4);
  for (World* world : {&cpu, &gpu})
    expect_true("one viscosity for both",
                world->set_viscosity(0, 0.03) && world->plan().has(PassId::kOneViscosity));
  step(cpu, 0.09);
  step(gpu, 0.09);
  compare_worlds(cpu, gpu, 1e-4);
}

// Left on the GPU, brought ten steps later by another thread, when the world is gone.
void compare_later() {
  std::printf("a snapshot brought later\n");
  std::optional<World> world = world_on(Backend::kCuda, shaken(stirred_tank(ParticleModel::kCorrected)));
  const Result<bool> shared = world->share_particles();
  const bool shares = shared && shared.value();
  if (!shares) std::printf("  this driver shares nothing: it is brought at once\n");
  step(*world, 0.09);
  Snapshot now, later;
  world->fill(now);
  world->fill_later(later);
  expect_true("its particles stay behind where the driver shares", shares == later.positions.empty());
  for (int i = 0; i < 10; ++i) step(*world, 0.09);
  world.reset();
  std::thread([&] { later.complete(); }).join();
  expect_true("the same particles", now.positions == later.positions && now.fluid_index == later.fluid_index);
}

struct Mean {
  double weight = 0.0, height = 0.0, kinetic = 0.0, compression = 0.0;
};

Mean last_fifth(World& world, double seconds, double hand_height) {
  Mean mean;
  int count = 0;
  BodySnapshot snapshot;
  while (world.time() < seconds) {
    step(world, hand_height);
    if (world.time() < 0.8 * seconds) continue;
    world.fill(snapshot);
    const Diagnostics d = world.diagnostics();
    mean.weight -= snapshot.bodies[0].fluid.force.y / (9.81 * d.mass);
    mean.height += d.center.y;
    mean.kinetic += d.kinetic_energy;
    mean.compression += d.max_compression;
    ++count;
  }
  return {mean.weight / count, mean.height / count, mean.kinetic / count, mean.compression / count};
}

void compare_second(const char* name, const Tank& tank, double settle, double tolerance,
                    double energy_tolerance) {
  std::printf("%s, 1 s, means of its last fifth\n", name);
  World cpu = world_on(Backend::kCpu, tank);
  World gpu = world_on(Backend::kCuda, tank);
  cpu.settle(settle);
  gpu.settle(settle);
  const Mean a = last_fifth(cpu, 1.0, 0.09);
  const Mean b = last_fifth(gpu, 1.0, 0.09);
  std::printf("  CPU: weight %.5f, height %.6f m, kinetic %.4g J; GPU: %.5f, %.6f m, %.4g J\n", a.weight,
              a.height, a.kinetic, b.weight, b.height, b.kinetic);
  expect_at_most("force on the walls / weight of the fluid", std::abs(a.weight - b.weight), tolerance);
  expect_at_most("height of the centre of mass", std::abs(b.height / a.height - 1.0), tolerance);
  const double potential = 9.81 * cpu.diagnostics().mass * a.height;
  expect_at_most("kinetic energy / potential energy", std::abs(a.kinetic - b.kinetic) / potential,
                 energy_tolerance);
  std::printf("  retired: CPU %llu, GPU %llu\n", static_cast<unsigned long long>(cpu.diagnostics().retired),
              static_cast<unsigned long long>(gpu.diagnostics().retired));
  expect_true("as many retired", cpu.diagnostics().retired == gpu.diagnostics().retired);
  expect_true("the same status", cpu.take_status() == gpu.take_status());
}

void compare_probe() {
  std::printf("probe drawn through a tank, 200 steps\n");
  const Tank tank = probed_tank();
  glm::dvec3 mean[2]{};
  glm::dvec3 at[2]{};
  double drag[2]{};  // N, against the way it goes
  int n = 0;
  for (const Backend backend : {Backend::kCpu, Backend::kCuda}) {
    World world = world_on(backend, tank);
    BodySnapshot snapshot;
    for (int i = 0; i < 200; ++i) {
      step(world, 0.05);
      world.fill(snapshot);
      const glm::dvec3 way = snapshot.bodies[1].twist.linear;
      drag[n] -= glm::dot(snapshot.bodies[1].fluid.force, way) / (200.0 * std::max(glm::length(way), 1e-9));
      mean[n] += snapshot.bodies[1].fluid.force / 200.0;
    }
    at[n++] = snapshot.bodies[1].pose.position;
  }
  std::printf("  CPU %.6f %.6f %.6f N, GPU %.6f %.6f %.6f N\n", mean[0].x, mean[0].y, mean[0].z, mean[1].x,
              mean[1].y, mean[1].z);
  expect_true("the fluid drags it", drag[0] > 1e-4 && drag[1] > 1e-4);
  expect_at_most("mean drag", std::abs(drag[1] / drag[0] - 1.0), 0.05);
  expect_at_most("mean force on the probe", glm::distance(mean[0], mean[1]) / glm::length(mean[0]), 0.05);
  expect_at_most("where it is at last, m", glm::distance(at[0], at[1]), 5e-4);
}

void compare_retired() {
  std::printf("particles that leave, are not numbers or are too fast\n");
  Tank tank = make_tank({});
  SampledScene& s = tank.sampled;
  s.fluid_positions[0] = {100.0f, 0.0f, 0.0f};
  s.fluid_positions[1].x = std::numeric_limits<float>::quiet_NaN();
  for (int i = 5; i < 25; ++i) s.fluid_velocities[i] = {0.0f, 1e9f, 0.0f};
  std::optional<View> views[2];
  std::uint32_t status[2];
  int n = 0;
  for (const Backend backend : {Backend::kCpu, Backend::kCuda}) {
    World world = world_on(backend, tank);
    for (int i = 0; i < 150; ++i) world.step({});
    views[n].emplace(world);
    status[n++] = world.take_status();
  }
  std::printf("  CPU %llu retired, GPU %llu; status %s\n",
              static_cast<unsigned long long>(views[0]->sums.retired),
              static_cast<unsigned long long>(views[1]->sums.retired), status_text(status[1]).c_str());
  expect_true("some are retired, the two from the start among them",
              views[1]->sums.retired > 2 && views[1]->snapshot.fluid_index[0] == 255 &&
                  views[1]->snapshot.fluid_index[1] == 255 && views[1]->snapshot.fluid_index[2] == 0);
  expect_true("as many on both", views[0]->sums.retired == views[1]->sums.retired);
  expect_true("as many spilled, as many lost", views[0]->sums.spilled == views[1]->sums.spilled &&
                                                   views[0]->sums.lost == views[1]->sums.lost &&
                                                   views[1]->sums.lost >= 1 && views[1]->sums.spilled > 1);
  expect_true("the same status", status[0] == status[1]);
  expect_true("energy stays finite", std::isfinite(views[1]->sums.kinetic_energy));
}

void compare_squeezed() {
  std::printf("fluid at four times its density\n");
  Tank tank = make_tank({});
  for (glm::vec3& x : tank.sampled.fluid_positions) x = x * 0.63f;
  for (const Backend backend : {Backend::kCpu, Backend::kCuda}) {
    World world = world_on(backend, tank);
    world.step({});
    world.step({});  // a GPU says so one step later
    expect_true("both say so", (world.take_status() & kStatusCompressed) != 0);
    expect_true("once", (world.take_status() & kStatusCompressed) == 0);
  }
}

void compare_clamped() {
  std::printf("fluid thrown at the walls of a tank that a hand moves\n");
  const Tank tank = thrown_tank();
  World cpu = world_on(Backend::kCpu, tank);
  World gpu = world_on(Backend::kCuda, tank);
  int steps = 0;
  // On from the first step in which a wall holds something back: the step after it has the impulse.
  for (int after = 0; steps < 100 && after < 2; ++steps) {
    step(cpu, 0.0);
    step(gpu, 0.0);
    after += cpu.diagnostics().clamped > 0;
  }
  const Diagnostics a = cpu.diagnostics(), b = gpu.diagnostics();
  std::printf("  %d steps, put back: CPU %llu, GPU %llu\n", steps, static_cast<unsigned long long>(a.clamped),
              static_cast<unsigned long long>(b.clamped));
  expect_true("particles are put back on both", a.clamped > 0 && b.clamped > 0);
  expect_at_most("and as many, but for rounding",
                 std::abs(static_cast<double>(b.clamped) / static_cast<double>(a.clamped) - 1.0), 0.02);
  expect_at_most("impulse on its way to the walls / momentum",
                 glm::length(a.clamp_impulse - b.clamp_impulse) / glm::length(a.momentum), 1e-3);
  compare_worlds(cpu, gpu, 1e-2);
  for (int i = 0; i < 100; ++i) {
    step(cpu, 0.0);
    step(gpu, 0.0);
  }
  expect_true("both say so", (cpu.take_status() & gpu.take_status() & kStatusClamped) != 0);
  for (const World* world : {&cpu, &gpu}) {
    Snapshot s;
    world->fill(s);
    const std::size_t outside = report::count_outside(s, s.rigid.bodies[0].pose,
                                                      {{-0.105, -0.005, -0.105}, {0.105, 0.19, 0.105}, true});
    const auto through = static_cast<double>(outside - world->diagnostics().retired);
    // The tank is open: what splashes over its rim comes to lie beside it. Closed vessels, in which nothing
    // may be lost, are `slosh report stability`'s.
    std::printf("  %llu retired, over the rim and out\n",
                static_cast<unsigned long long>(world->diagnostics().retired));
    expect_at_most("particles that lie outside, over the rim",
                   through / static_cast<double>(s.positions.size()), 2e-3);
  }
}

constexpr ParticleModel kModels[] = {ParticleModel::kCorrected, ParticleModel::kPaper};

void compare_single_steps() {
  for (const ParticleModel model : kModels) {
    const Tank tank = shaken(stirred_tank(model));
    const std::string name = std::string(slosh::name(model)) + " model, two fluids, paddle";
    const Plan plan = make_plan(tank.scene, tank.sampled.spacing, false);
    compare_steps(name.c_str(), tank, plan, 1, 1e-5);
    compare_steps(name.c_str(), tank, plan, 10, 1e-3);
    const Tank honey = shaken(paddle_in_honey(model));
    const Plan thick = make_plan(honey.scene, honey.sampled.spacing, false);
    compare_steps("light paddle in honey, one viscosity", honey, thick, 1, 1e-5);
    compare_steps("light paddle in honey, one viscosity", honey, thick, 10, 1e-3);
    Tank one = shaken(make_tank({}));
    one.scene.model = model;
    one.scene.tension = 1.0;
    Plan variant = make_plan(one.scene, one.sampled.spacing, false);
    compare_steps("one viscosity, tension", one, variant, 1, 1e-5);
    variant.runs.set(PassId::kOneViscosity, false);
    compare_steps("no viscosity", one, variant, 1, 1e-5);
  }
}

/// Pairs about to lose each other: of the sums over a particle's neighbours rounding leaves what it will.
void compare_parting_pairs() {
  std::printf("pairs of thick fluid at the end of their reach, 40 steps\n");
  TankOptions options;
  options.inner = {0.4, 0.3, 0.4};
  options.viscosity = 1.5;
  options.spacing = 0.008;
  Tank tank = make_tank(options);
  const auto reach = static_cast<float>(tank.scene.support_ratio * tank.sampled.spacing);
  SampledScene& s = tank.sampled;
  s.fluid_positions.clear();
  s.fluid_velocities.clear();
  std::uint32_t state = 5;
  const auto any = [&state] {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) / 8388608.0f - 1.0f;
  };
  for (int i = 0; i < 8 * 5 * 8; ++i) {
    const glm::vec3 at(0.047f * static_cast<float>(i % 8) - 0.165f,
                       0.05f + 0.047f * static_cast<float>(i / 64),
                       0.047f * static_cast<float>(i / 8 % 8) - 0.165f);
    const glm::vec3 way = glm::normalize(glm::vec3(any(), any(), any()) + 1e-3f);
    s.fluid_positions.push_back(at);
    s.fluid_positions.push_back(at + reach * (0.985f + 0.015f * any()) * way);
    s.fluid_velocities.push_back(glm::vec3(0.1f, 0.2f, -0.1f) - 0.03f * way);
    s.fluid_velocities.push_back(glm::vec3(0.1f, 0.2f, -0.1f) + 0.03f * way);
  }
  s.fluid_index.assign(s.fluid_positions.size(), 0);
  const Plan plan = make_plan(tank.scene, s.spacing);
  expect_true("the plan has the particles' stress", plan.has(PassId::kFluidStress));
  for (const Backend backend : {Backend::kCpu, Backend::kCuda}) {
    World world = world_on(backend, tank, plan);
    for (int i = 0; i < 40; ++i) world.step({});
    expect_at_most("particles lost", static_cast<double>(world.diagnostics().lost), 0.0);
  }
}

int conclude() {
  std::printf(failures() ? "%d comparison(s) FAILED\n" : "all agree (%d failures)\n", failures());
  return failures() ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const CudaDevice device = find_cuda_device();
  if (!device.available) {
    std::printf("no GPU here (%s): compiled, not run\n", device.reason.c_str());
    return 77;
  }
  std::printf("%s\n", device.name.c_str());
  const std::string part = argc > 1 ? argv[1] : "all";
  const bool quick = part == "quick", whole = part == "all";
  if (quick) compare_viscous_step();
  if (quick) compare_pressed_steps();
  if (quick || whole || part == "slipping") compare_slipping();
  if (quick || whole) compare_parting_pairs();
  if (quick || whole || part == "warm") compare_warm();
  if (quick || whole || part == "coming") compare_coming();
  if (quick || whole || part == "cut") compare_cut();
  if (whole || part == "viscous") compare_viscous();
  if (whole || part == "pressed") compare_pressed();
  if (part == "viscous" || part == "pressed" || part == "slipping" || part == "warm" || part == "coming" ||
      part == "cut")
    return conclude();
  compare_single_steps();
  if (quick) return conclude();
  // Large enough to fill the GPU: blocks come and go in another order each time.
  for (const ParticleModel model : kModels) {
    Tank large = shaken(pool(300000));
    large.scene.model = model;
    const Plan plan = make_plan(large.scene, large.sampled.spacing, false);
    compare_steps((std::string("large pool, ") + name(model)).c_str(), large, plan, 1, 1e-5);
    repeat("large pool", large, 0.09, 20);
  }
  compare_second("tank at rest", make_tank({}), 0.5, 2e-3, 1e-4);
  compare_second("two fluids stirred by a paddle", stirred_tank(ParticleModel::kCorrected), 0.0, 2e-2, 1e-2);
  repeat("two fluids, paddle", stirred_tank(ParticleModel::kCorrected), 0.09);
  repeat("paper model", stirred_tank(ParticleModel::kPaper), 0.09);
  repeat("probe", probed_tank(), 0.05);
  compare_probe();
  compare_restored("two fluids, paddle", stirred_tank(ParticleModel::kCorrected), 0.09);
  compare_restored("probe", probed_tank(), 0.05);
  compare_changed();
  compare_later();
  compare_retired();
  compare_squeezed();
  compare_clamped();
  repeat("fluid thrown at walls", thrown_tank(), 0.0);
  compare_restored("fluid thrown at walls", thrown_tank(), 0.0);
  return conclude();
}
