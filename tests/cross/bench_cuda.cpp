// A pool of fluid at growing counts, step after step: CSV on standard output.
// Usage: bench_cuda [drag] [MODEL] [cuda|cpu] [particles…]
// MODEL: paper, corrected or incompressible; the default one unless named. At rest; or with
// `drag` turning, without viscosity, at 50 Pa·s by explicit steps and at 50 Pa·s solved.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "tests/cross/worlds.h"

namespace {

using namespace slosh;

enum class Drag { kResting, kNone, kStepped, kSolved };

const char* name(Drag drag) {
  return drag == Drag::kResting  ? "at rest"
         : drag == Drag::kNone   ? "inviscid"
         : drag == Drag::kSolved ? "50 Pa·s, implicit"
                                 : "50 Pa·s, explicit";
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

testing::Tank pool_for(ParticleModel model, Drag drag, double particles) {
  testing::Tank pool = testing::pool(particles);
  pool.scene.model = model;
  pool.scene.bodies[0].measured = false;
  if (drag == Drag::kResting) return pool;
  pool.scene.fluids[0].dynamic_viscosity = drag == Drag::kNone ? 0.0 : 50.0;
  pool.scene.bodies[0].dynamic_viscosity = drag == Drag::kNone ? 0.0 : kFluidsViscosity;
  for (std::size_t p = 0; p < pool.sampled.fluid_positions.size(); ++p) {
    const glm::vec3& x = pool.sampled.fluid_positions[p];
    pool.sampled.fluid_velocities[p] = {-x.z, 0.0f, x.x};  // 0.7 m/s in the corners
  }
  return pool;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

struct Length {
  int warm_up, steps;
};

// False when the backend is not there.
bool measure(Backend backend, ParticleModel model, Drag drag, double particles, const Length& length) {
  const testing::Tank pool = pool_for(model, drag, particles);
  Result<World> made =
      make_world(pool.scene, pool.sampled, make_plan(pool.scene, pool.sampled.spacing, drag == Drag::kSolved),
                 {0, backend});
  if (!made) {
    std::fprintf(stderr, "%s\n", made.error().text().c_str());
    return false;
  }
  World& world = made.value();
  for (int i = 0; i < length.warm_up; ++i) world.step({});
  std::array<std::vector<double>, kPassCount> times;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < length.steps; ++i) {
    world.step({});
    for (std::size_t p = 0; p < kPassCount; ++p) times[p].push_back(world.times().pass[p]);
  }
  // What the last step has still under way is as much as the warm-up had.
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / length.steps;
  const Diagnostics after = world.diagnostics();
  const double count = static_cast<double>(world.fluid_count());
  // Solves take as many iterations as they need: what is typical says little there.
  const bool solved = drag != Drag::kResting || model == ParticleModel::kIncompressible;
  std::printf("\"%s\",%s,\"%s\",%zu,%zu,%.3f,%.4f,%.3f,%.1f,%llu", world.backend().c_str(), name(model),
              name(drag), world.fluid_count(), world.boundary_count(), 1e3 * world.plan().time_step,
              1e3 * seconds, 1e9 * seconds / count, 1.0 / seconds,
              static_cast<unsigned long long>(after.retired));
  for (const std::vector<double>& pass : times)
    std::printf(",%.4f", 1e3 * (solved ? mean(pass) : median(pass)));
  std::puts("");
  std::fflush(stdout);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  bool drag = false;
  Backend backend = Backend::kCuda;
  ParticleModel model = Scene{}.model;
  std::vector<double> sizes;
  for (const std::string& word : std::vector<std::string>(argv + 1, argv + argc)) {
    const std::optional<ParticleModel> named = model_named(word);
    if (word == "drag") {
      drag = true;
    } else if (word == "cuda" || word == "cpu") {
      backend = word == "cpu" ? Backend::kCpu : Backend::kCuda;
    } else if (named) {
      model = *named;
    } else if (std::atof(word.c_str()) >= 1.0) {
      sizes.push_back(std::atof(word.c_str()));
    } else {
      std::fprintf(
          stderr,
          "bench_cuda: '%s' is neither drag, nor a model, nor cuda or cpu, nor a count of particles\n",
          word.c_str());
      return 2;
    }
  }
  if (sizes.empty()) sizes = {32768, 131072, 524288, 1048576, 2097152};
  std::printf(
      "backend,model,drag,fluid_particles,body_particles,time_step_ms,step_ms,ns_per_particle,steps_per_s,"
      "retired");
  for (std::size_t p = 0; p < kPassCount; ++p) std::printf(",%s_ms", slosh::name(static_cast<PassId>(p)));
  std::puts("");
  // A warp is quicker while the fluid still lies in rows: a million's density pass takes 0.28 ms after 100
  // steps and 0.30 after 1000 (tests/notebook/2026-11-29-bytes-for-candidates.md).
  const Length length = backend == Backend::kCuda ? Length{1000, 200} : Length{5, 20};
  const std::vector<Drag> ways =
      drag ? std::vector{Drag::kNone, Drag::kStepped, Drag::kSolved} : std::vector{Drag::kResting};
  for (const double size : sizes) {
    for (const Drag way : ways) {
      if (!measure(backend, model, way, size, length)) return 1;
    }
  }
  return 0;
}
