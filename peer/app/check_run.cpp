#include "peer/app/check_run.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "net/clock.h"
#include "net/grip_start.h"
#include "peer/app/settle_world.h"
#include "peer/app/time_estimate.h"
#include "peer/output/summary.h"
#include "sim/math/format.h"
#include "sim/world.h"

namespace slosh {
namespace {

constexpr double kMuchLeft = 0.005;  // of the fluid
constexpr double kThinLayer = 1.5;   // spacings: one layer of particles, and what lies on it here and there
constexpr double kMuchCompressed = 0.25;  // ρ/ρ⁰ − 1: a settled head is a few per cent

/// World::settle asks a plain function.
struct Settling {
  Progress* progress = nullptr;
  double steps = 1.0, done = 0.0;
  std::int64_t tell_from_ns = 0, until_ns = 0;
  bool cut_short = false;
};
Settling settling;

bool settled_enough() {
  const std::int64_t now_ns = steady_now_ns();
  if (now_ns > settling.tell_from_ns)
    settling.progress->update(settling.done / settling.steps,
                              "the scene settles, then its hands are watched (--static leaves that out)");
  settling.done += 1.0;
  settling.cut_short = now_ns > settling.until_ns;
  return settling.cut_short;
}

std::vector<HandleInput> still_hands(const Scene& scene) {
  std::vector<HandleInput> hands;
  for (std::size_t i = 0; i < scene.grips.size(); ++i) {
    const std::vector<PoseKey>& script = scene.grips[i].hand_motion;
    hands.push_back({script.empty() ? grip_start(scene, i) : script.front().pose, Twist{}, true, 1.0});
  }
  return hands;
}

/// Unit, against gravity; y where there is none.
glm::dvec3 up_of(const Scene& scene) {
  const double g = glm::length(scene.gravity);
  return g > 0.0 ? -scene.gravity / g : glm::dvec3(0.0, 1.0, 0.0);
}

double lowest_body(const Scene& scene, const BodySnapshot& now, const glm::dvec3& up) {
  double lowest = INFINITY;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Pose& pose = now.bodies[b].pose;
    if (scene.bodies[b].mesh < 0) {
      lowest = std::min(lowest, glm::dot(up, pose.position));
      continue;
    }
    for (const glm::vec3& p : scene.meshes[static_cast<std::size_t>(scene.bodies[b].mesh)].positions)
      lowest = std::min(lowest, glm::dot(up, transform_point(pose, glm::dvec3(p))));
  }
  return lowest;
}

/// Of columns two spacings wide, what stands in them, as the mean over particles: splashes count for little.
double layer_depth(const std::vector<glm::dvec3>& particles, const glm::dvec3& up, double spacing) {
  const glm::dvec3 aside = std::abs(up.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
  const glm::dvec3 u = glm::normalize(glm::cross(up, aside));
  const glm::dvec3 v = glm::cross(up, u);
  const double wide = 2.0 * spacing;
  std::map<std::pair<long, long>, double> columns;
  for (const glm::dvec3& p : particles)
    columns[{std::lround(glm::dot(u, p) / wide), std::lround(glm::dot(v, p) / wide)}] += 1.0;
  double squares = 0.0;
  for (const auto& [place, count] : columns) squares += count * count;
  return squares / static_cast<double>(particles.size()) * spacing * spacing * spacing / (wide * wide);
}

void look_at_fluid(const Scene& scene, const World& world, CheckRun& run) {
  Snapshot now;
  world.fill(now);
  const glm::dvec3 up = up_of(scene);
  const double floor = lowest_body(scene, now.rigid, up) - 2.0 * world.plan().spacing;
  std::vector<std::vector<glm::dvec3>> there(scene.fluids.size());
  for (std::size_t i = 0; i < now.positions.size(); ++i) {
    if (now.fluid_index[i] >= there.size()) continue;  // it has left
    const glm::dvec3 p(now.positions[i]);
    if (glm::dot(up, p) < floor)
      ++run.falling;
    else
      there[now.fluid_index[i]].push_back(p);
  }
  for (std::size_t f = 0; f < there.size(); ++f) {
    if (there[f].empty()) continue;
    run.layers.push_back({scene.fluids[f].name, layer_depth(there[f], up, world.plan().spacing)});
  }
}

/// What hands felt while they stood still.
struct Trace {
  glm::dvec3 low{INFINITY}, high{-INFINITY}, sum{0.0};
};

}  // namespace

Result<CheckRun> run_for_check(const Scene& scene, const SampledScene& sampled, const Plan& plan,
                               Progress& progress) {
  CheckRun run;
  const std::int64_t begin_ns = steady_now_ns();
  Result<World> made = make_world(scene, sampled, plan, WorldOptions{0, Backend::kCpu});
  if (!made) return made.error();
  World& world = made.value();
  run.fluid = world.fluid_count();
  const std::vector<HandleInput> hands = still_hands(scene);
  const double step = plan.time_step;
  const double cost = std::max(measure_step(world, hands), 1e-9);
  // The watching gets its share first: settling is what may be cut short.
  const double watch_cost = cost * std::ceil(kWatched / step);
  if (watch_cost > 0.5 * kCheckBudget) return run;
  constexpr double kQuiet = 1.5;  // s: what is shorter needs no words
  settling = {&progress,
              std::max(1.0, scene.settle / step),
              0.0,
              begin_ns + to_nanoseconds(kQuiet),
              begin_ns + to_nanoseconds(kCheckBudget - watch_cost),
              false};
  run.settled = world.settle(scene.settle, hands, settled_enough, scene.settle_longest);
  run.cut_short = settling.cut_short;
  run.settling = world.diagnostics().retired;
  std::vector<Trace> traces(scene.grips.size());
  BodySnapshot now;
  double steps = 0.0;
  for (; run.watched + 0.5 * step < kWatched; run.watched += step) {
    world.step(hands);
    world.fill(now);
    // Half of it is for hands and world to find each other.
    if (run.watched < 0.5 * kWatched) continue;
    steps += 1.0;
    for (std::size_t g = 0; g < traces.size(); ++g) {
      const glm::dvec3& force = now.grips[g].on_hand.force;
      traces[g].low = glm::min(traces[g].low, force);
      traces[g].high = glm::max(traces[g].high, force);
      traces[g].sum += force;
    }
  }
  for (std::size_t g = 0; g < traces.size() && steps > 0.0; ++g)
    run.hands.push_back({scene.grips[g].name, glm::length(traces[g].sum) / steps,
                         0.5 * glm::length(traces[g].high - traces[g].low)});
  const Diagnostics end = world.diagnostics();
  run.left = end.retired;
  run.compression = end.max_compression;
  look_at_fluid(scene, world, run);
  return run;
}

std::string rest_in_words(const CheckRun& run) {
  if (run.watched <= 0.0)
    return "not tried: it would take longer than the " + format("%.0f s", kCheckBudget) +
           " that check has for it";
  std::string text =
      run.cut_short ? format("settled only %.2g s in the time that check has; ", run.settled) : "";
  for (const CheckRun::Felt& hand : run.hands)
    text += hand.grip + format(" feels %.3g N, within %.2g; ", hand.force, hand.swing);
  text += format("%.3g %% of the fluid stays",
                 run.fluid > 0 ? 100.0 * static_cast<double>(run.fluid - run.left - run.falling) /
                                     static_cast<double>(run.fluid)
                               : 100.0);
  return text;
}

void judge_run(const Scene& scene, const CheckRun& run, double spacing, Inspection& found) {
  const auto warn = [&](const char* kind, const std::string& where, const std::string& what,
                        const std::string& mend) {
    found.warnings.push_back({kind, {scene.source_file + where, what, mend}});
  };
  if (run.fluid > 0 && run.settling >= run.fluid) {
    found.errors.push_back({"error", all_left_while_settling(scene)});
    return;
  }
  if (run.watched <= 0.0) return;
  const std::size_t lost = run.left + run.falling;
  if (static_cast<double>(lost) > kMuchLeft * static_cast<double>(run.fluid)) {
    const bool nowhere = lost >= run.fluid;
    warn("spills", "",
         nowhere
             ? "its fluid lies in no vessel: all of it has left, or falls past every body, after " +
                   format("%.2g s", run.settled + run.watched)
             : grouped(lost) + " of " + grouped(run.fluid) +
                   format(" fluid particles (%.2g %%)",
                          100.0 * static_cast<double>(lost) / static_cast<double>(run.fluid)) +
                   " leave what holds them before a hand has moved: they run off an edge or through a gap",
         "Look where with 'slosh play'; put the fluid into a vessel with a floor and walls higher than it, "
         "and close the vessel's mesh");
  }
  for (const CheckRun::Layer& layer : run.layers) {
    if (layer.depth >= kThinLayer * spacing) continue;
    warn(
        "thin-layer", ": fluid '" + layer.fluid + "'",
        format(
            "lies %.2g mm deep at particles of %.3g mm: a layer thinner than two particles flows as beads do",
            1e3 * layer.depth, 1e3 * spacing),
        format("Give finer particles (--spacing %.2g, the scene's spacing_max_m), more fluid, or a narrower "
               "vessel",
               0.5 * layer.depth));
  }
  if (run.compression > kMuchCompressed)
    warn("squeezed", "",
         format("fluid is squeezed to %.2g times its density somewhere", 1.0 + run.compression),
         "Look for volumes of fluid, or bodies, that share one place, and for a space that is too narrow for "
         "its fluid");
  const auto thrown = [](const Body& body) {
    return body.twist.linear != glm::dvec3(0.0) || body.twist.angular != glm::dvec3(0.0);
  };
  const bool starts_moving = std::ranges::any_of(scene.bodies, thrown) ||
                             std::ranges::any_of(scene.fluid_volumes, [](const FluidVolume& volume) {
                               return volume.velocity != glm::dvec3(0.0);
                             });
  for (const CheckRun::Felt& hand : run.hands) {
    // What had no time to settle here has it in a run.
    if (hand.steady() || starts_moving || run.cut_short) continue;
    warn("restless", ": node '" + hand.grip + "'",
         format("does not start at rest: the hand feels %.3g N, give or take %.2g", hand.force, hand.swing),
         run.settled > 0.0
             ? format("Give the scene settle_s = %.2g", std::min(2.0 * run.settled, 60.0))
             : std::string("Leave the scene's settle_s out: the world comes to rest before the run"));
  }
}

}  // namespace slosh
