// What the simulation costs: a whole step of `pool` at several sizes, what implicit viscosity adds to one,
// and the shipped bucket in two hands, with what they feel against its weight. Known answers and passes:
// `slosh report`.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "scenes/load.h"
#include "scenes/sample.h"
#include "sim/world.h"
#include "tests/physics/lab.h"
#include "tests/support/tank.h"

namespace {

using namespace slosh;

struct Row {
  std::string part, what;
  std::vector<std::pair<std::string, double>> values;
};

/// Prints rows as they come and keeps them for the file.
class Table {
 public:
  void add(Row row) {
    std::printf("%-8s %-44s", row.part.c_str(), row.what.c_str());
    for (const auto& [name, value] : row.values) std::printf("  %s %.4g", name.c_str(), value);
    std::printf("\n");
    std::fflush(stdout);
    rows_.push_back(std::move(row));
  }

  /// One line a value: part,what,quantity,value.
  bool write(const std::string& file) const {
    std::ofstream out(file);
    out << "part,what,quantity,value\n";
    for (const Row& row : rows_) {
      for (const auto& [name, value] : row.values)
        out << row.part << ',' << row.what << ',' << name << ',' << value << '\n';
    }
    return out.good();
  }

 private:
  std::vector<Row> rows_;
};

using Models = std::vector<ParticleModel>;

double percentile(std::vector<double> values, double share) {
  const auto nth = values.begin() + static_cast<long>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

Result<Scene> shipped(const char* name) {
  const auto file = find_scene(name);
  if (!file) return file.error();
  return load_scene(file.value());
}

/// Samples so that there are close to `count` fluid particles, then keeps exactly `count` (the lowest).
Result<SampledScene> sample_count(const Scene& scene, std::size_t count) {
  double spacing = std::cbrt(estimate_particles(scene, 1.0).fluid / static_cast<double>(count));
  for (int tries = 0; tries < 12; ++tries) {
    Result<SampledScene> sampled = sample_scene(scene, spacing);
    if (!sampled) return sampled;
    SampledScene& s = sampled.value();
    if (s.fluid_positions.size() < count) {
      spacing *= 0.99 * std::cbrt(static_cast<double>(s.fluid_positions.size()) / static_cast<double>(count));
      continue;
    }
    std::sort(s.fluid_positions.begin(), s.fluid_positions.end(),
              [](const glm::vec3& a, const glm::vec3& b) { return a.y < b.y; });
    s.fluid_positions.resize(count);
    s.fluid_velocities.assign(count, glm::vec3(0.0f));
    s.fluid_index.resize(count);
    return sampled;
  }
  return Error{"pool", "no spacing gives the particle count", "report this"};
}

struct Timing {
  std::vector<double> total;
  std::array<std::vector<double>, kPassCount> pass;
};

Timing time_steps(World& world, const std::vector<HandleInput>& hands, int steps) {
  Timing t;
  for (int i = 0; i < steps; ++i) {
    world.step(hands);
    const StepTimes& s = world.times();
    t.total.push_back(s.total);
    for (std::size_t p = 0; p < kPassCount; ++p) t.pass[p].push_back(s.pass[p]);
  }
  return t;
}

std::vector<HandleInput> first_hands(const Scene& scene) {
  std::vector<HandleInput> hands(scene.grips.size());
  for (std::size_t g = 0; g < hands.size(); ++g) {
    hands[g].pose = compose(scene.bodies[scene.grips[g].body].pose, scene.grips[g].pose);
    hands[g].engaged = true;
  }
  return hands;
}

void add_timing(Table& table, const char* part, const std::string& what, const World& world,
                const Timing& t) {
  const double total = percentile(t.total, 0.5);
  const double fluid = static_cast<double>(world.fluid_count());
  Row row{part,
          what,
          {{"step_p50_ms", 1e3 * total},
           {"step_p99_ms", 1e3 * percentile(t.total, 0.99)},
           {"step_min_ms", 1e3 * percentile(t.total, 0.0)},
           {"ns_per_particle", 1e9 * total / fluid}}};
  for (std::size_t p = 0; p < kPassCount; ++p) {
    const double took = percentile(t.pass[p], 0.5);
    if (took > 0.0)
      row.values.push_back({std::string(name(static_cast<PassId>(p))) + "_percent", 100.0 * took / total});
  }
  row.values.insert(row.values.end(), {{"steps_per_s", 1.0 / total},
                                       {"dt_ms", 1e3 * world.plan().time_step},
                                       {"real_time_factor", world.plan().time_step / total}});
  table.add(row);
}

/// (a) A whole step of `pool`, its ball held and at rest, after the fluid has moved for a while.
bool bench_speed(Table& table, const std::vector<std::size_t>& counts, int steps, const Models& models) {
  Result<Scene> pool = shipped("pool");
  if (!pool) return std::fprintf(stderr, "%s\n", pool.error().text().c_str()), false;
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  for (const std::size_t count : counts) {
    // The scene's finest spacing is a wish for real time, not a limit of the sampler.
    const Result<SampledScene> sampled = sample_count(pool.value(), count);
    if (!sampled) return std::fprintf(stderr, "%s\n", sampled.error().text().c_str()), false;
    for (const ParticleModel model : models) {
      Scene scene = pool.value();
      scene.model = model;
      for (const int threads : {1, cores}) {
        World world(scene, sampled.value(), make_plan(scene, sampled.value().spacing),
                    {threads, Backend::kCpu});
        const std::vector<HandleInput> hands = first_hands(scene);
        time_steps(world, hands, 20);
        const Timing t = time_steps(world, hands, steps);
        add_timing(
            table, "speed",
            "pool " + std::to_string(count) + " " + name(model) + " threads " + std::to_string(threads),
            world, t);
        if (cores == 1) break;
      }
    }
  }
  return true;
}

/// A square column of about `count` particles at 10 mm, as high as wide, in a tank; it turns by 2 rad/s.
testing::Tank turning_column(std::size_t count, double viscosity) {
  testing::TankOptions options;
  const double side = options.spacing * std::round(std::cbrt(static_cast<double>(count)));
  options.inner = {side, 1.3 * side, side};
  options.fill = side;
  options.viscosity = viscosity;
  options.wall_viscosity = viscosity > 0.0 ? kFluidsViscosity : 0.0;
  testing::Tank tank = testing::make_tank(options);
  tank.scene.bodies[0].measured = false;
  for (std::size_t p = 0; p < tank.sampled.fluid_positions.size(); ++p) {
    const glm::vec3& x = tank.sampled.fluid_positions[p];
    tank.sampled.fluid_velocities[p] = 2.0f * glm::vec3(-x.z, 0.0f, x.x);
  }
  return tank;
}

// Of this thread's own work, whatever else runs on its core.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// (b) The same column without viscosity and with 50 Pa·s implicit, step by step in turns, so that what else
/// the machine does meets both: the steps in which it is set in motion, and those after. One thread.
bool bench_drag(Table& table, const std::vector<std::size_t>& counts, int steps, const Models& models) {
  constexpr int kFirst = 12;
  for (const std::size_t count : counts) {
    for (const ParticleModel model : models) {
      if (!corrects_gradients(model)) continue;
      std::vector<World> worlds;
      for (const double viscosity : {0.0, 50.0}) {
        testing::Tank tank = turning_column(count, viscosity);
        tank.scene.model = model;
        const Plan plan = make_plan(tank.scene, tank.sampled.spacing);
        if (plan.has(PassId::kImplicitViscosity) != (viscosity > 0.0))
          return std::fprintf(stderr, "the plan has no implicit viscosity\n"), false;
        worlds.emplace_back(tank.scene, tank.sampled, plan, WorldOptions{1, Backend::kCpu});
      }
      for (const bool first : {true, false}) {
        std::vector<double> times[2];
        for (int i = 0; i < (first ? kFirst : steps); ++i) {
          for (std::size_t w = 0; w < 2; ++w) {
            const double begin = thread_seconds();
            worlds[w].step({});
            times[w].push_back(thread_seconds() - begin);
          }
        }
        const double without = percentile(times[0], 0.5), with = percentile(times[1], 0.5);
        table.add({"drag",
                   std::string("column ") + std::to_string(worlds[0].fluid_count()) + " " + name(model) +
                       (first ? " first steps" : " later steps"),
                   {{"without_cpu_ms", 1e3 * without},
                    {"with_cpu_ms", 1e3 * with},
                    {"ratio", with / without},
                    {"without_min_ms", 1e3 * percentile(times[0], 0.0)},
                    {"with_min_ms", 1e3 * percentile(times[1], 0.0)}}});
      }
    }
  }
  return true;
}

/// (c) The shipped bucket in two hands.
bool bench_bucket(Table& table) {
  const Result<Scene> bucket = shipped("bucket");
  if (!bucket) return std::fprintf(stderr, "%s\n", bucket.error().text().c_str()), false;
  const Scene& scene = bucket.value();
  for (const double spacing : {0.012, 0.010, 0.008, 0.006}) {
    lab::Experiment e(scene, spacing);
    for (std::size_t g = 0; g < scene.grips.size(); ++g) e.handle(g) = first_hands(scene)[g];
    e.world().settle(0.6);
    e.run(0.5);
    lab::Average up;
    const auto start = std::chrono::steady_clock::now();
    e.run(0.5, [&] {
      double force = 0.0;
      for (const GripState& grip : e.bodies().grips) force -= grip.on_hand.force.y;
      up.add(force);
    });
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double weight = (scene.bodies[scene.grips[0].body].mass.mass + e.fluid_mass()) * lab::kGravity;
    char what[80];
    std::snprintf(what, sizeof what, "bucket %.4g mm", 1e3 * spacing);
    table.add({"error",
               what,
               {{"particles", static_cast<double>(e.world().fluid_count())},
                {"wall_s_per_simulated_s", wall / 0.5},
                {"hand_force_error_percent", 100.0 * (up.mean() / weight - 1.0)},
                {"noise_rms_percent", 100.0 * up.noise_share()},
                {"noise_peak_percent", 100.0 * up.peak_share()}}});
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Speed and error of the simulation"};
  std::string csv;
  std::string only;
  int steps = 100;
  std::vector<std::size_t> counts{4096, 8192, 16384, 32768, 65536, 131072};
  app.add_option("--csv", csv, "also write the results here");
  app.add_option("--only", only, "one part")->check(CLI::IsMember({"speed", "drag", "error"}));
  app.add_option("--steps", steps, "steps that are timed for each row")->check(CLI::Range(1, 100000));
  app.add_option("--counts", counts, "particle counts of the speed and drag parts");
  Models models{ParticleModel::kCorrected, ParticleModel::kPaper, ParticleModel::kIncompressible};
  std::string only_model;
  app.add_option("--model", only_model, "one model in the speed and drag parts")
      ->check(CLI::IsMember({"corrected", "paper", "incompressible"}));
  CLI11_PARSE(app, argc, argv);
  if (!only_model.empty())
    std::erase_if(models, [&](ParticleModel model) { return name(model) != only_model; });
  Table table;
  bool good = true;
  if (only.empty() || only == "speed") good = bench_speed(table, counts, steps, models) && good;
  if (only.empty() || only == "drag") good = bench_drag(table, counts, steps, models) && good;
  if (only.empty() || only == "error") good = bench_bucket(table) && good;
  if (!csv.empty() && !table.write(csv)) {
    std::fprintf(stderr, "%s: cannot be written\n", csv.c_str());
    good = false;
  }
  return good ? 0 : 1;
}
