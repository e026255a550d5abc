// A pool of fluid at rest at growing counts, step after step: CSV on standard output.
// Usage: bench_cuda [cuda|cpu [particles…]]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/cross/worlds.h"

namespace {

using namespace slosh;

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// False when the backend is not there.
bool measure(Backend backend, double particles, int warm_up, int steps) {
  testing::Tank pool = testing::pool(particles);
  pool.scene.bodies[0].measured = false;
  Result<World> made =
      make_world(pool.scene, pool.sampled, make_plan(pool.scene, pool.sampled.spacing), {0, backend});
  if (!made) {
    std::fprintf(stderr, "%s\n", made.error().text().c_str());
    return false;
  }
  World& world = made.value();
  for (int i = 0; i < warm_up; ++i) world.step({});
  std::vector<double> sort, density, force;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < steps; ++i) {
    world.step({});
    sort.push_back(world.times().sort);
    density.push_back(world.times().density);
    force.push_back(world.times().force);
  }
  // What the last step has still under way is as much as the warm-up had.
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / steps;
  const Diagnostics after = world.diagnostics();
  const double count = static_cast<double>(world.fluid_count());
  std::printf("\"%s\",%zu,%zu,%.3f,%.4f,%.4f,%.4f,%.4f,%.3f,%.1f,%llu\n", world.backend().c_str(),
              world.fluid_count(), world.boundary_count(), 1e3 * world.plan().time_step, 1e3 * seconds,
              1e3 * median(sort), 1e3 * median(density), 1e3 * median(force), 1e9 * seconds / count,
              1.0 / seconds, static_cast<unsigned long long>(after.retired));
  std::fflush(stdout);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const Backend backend = argc > 1 && std::string(argv[1]) == "cpu" ? Backend::kCpu : Backend::kCuda;
  std::vector<double> sizes;
  for (int i = 2; i < argc; ++i) sizes.push_back(std::atof(argv[i]));
  if (sizes.empty()) sizes = {32768, 131072, 524288, 1048576, 2097152};
  std::puts(
      "backend,fluid_particles,body_particles,time_step_ms,step_ms,sort_ms,density_ms,force_ms,ns_per_"
      "particle,"
      "steps_per_s,retired");
  const bool gpu = backend == Backend::kCuda;
  for (const double size : sizes) {
    if (!measure(backend, size, gpu ? 100 : 5, gpu ? 200 : 20)) return 1;
  }
  return 0;
}
