#include "tests/lab/coupling/water_study.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>

#include "net/clock.h"
#include "peer/devices/operator_device.h"
#include "peer/haptics/script_device.h"
#include "scenes/load.h"
#include "scenes/sample.h"
#include "sim/fluid_models.h"
#include "sim/world.h"

namespace slosh::coupling {
namespace {

constexpr double kWaterPeriod = 0.001;  // s, of a device's tick and of a step
constexpr double kWaterMoves = kWaterStops - kWaterBegins;
constexpr double kSwells = 0.5;        // s, at the begin and the end of the way
constexpr double kMaxDamping = 100.0;  // N·s/m that the device holds

std::vector<PoseKey> keys_of(const WaterCase& c, const Pose& start) {
  const WaterWay way = way_of(c);
  std::vector<PoseKey> keys;
  for (double u = 0.0; u <= kWaterMoves + 1e-9; u += 0.005) {
    const double in = std::clamp(std::min(u, kWaterMoves - u) / kSwells, 0.0, 1.0);
    const double place =
        (way.reach + c.nudge) * in * in * (3.0 - 2.0 * in) * std::sin(2.0 * std::numbers::pi * way.pace * u);
    PoseKey& key = keys.emplace_back();
    key.time = kWaterBegins + u;
    key.pose = start;
    key.pose.position += place * way.along;
  }
  return keys;
}

Result<Scene> scene_of() {
  const Result<std::filesystem::path> file = find_scene("bucket");
  if (!file) return file.error();
  Result<Scene> loaded = load_scene(file.value());
  if (!loaded) return loaded.error();
  Scene& scene = loaded.value();
  scene.grips.resize(1);
  // At its middle, as high as its handles: held by one of them it would tip.
  scene.grips[0].pose.position.x = 0.0;
  return loaded;
}

/// The host: one grip, one step a tick.
class Host {
 public:
  Host(const Scene& scene, const SampledScene& sampled, double spacing)
      : scene_(scene),
        world_(scene, sampled, plan_of(scene, spacing), WorldOptions{1, Backend::kCpu}),
        models_(scene),
        wanted_(scene.bodies.size(), 0),
        body_(static_cast<std::size_t>(scene.grips[0].body)) {
    wanted_[body_] = 1;
    world_.fill(now_);
    start_ = now_.grips[0].pose;
    world_.settle(2.0, std::vector<HandleInput>{{start_, Twist{}, true, 1.0}});
    world_.fill(now_);
  }
  const Pose& start() const { return start_; }
  Wrench felt(const DeviceReport& hand) const {
    return coupling_wrench_on_hand(gains(), hand.pose, hand.twist, now_.grips[0].pose, now_.grips[0].twist);
  }
  CouplingGains gains() const {
    const Grip& g = scene_.grips[0];
    return {g.stiffness, g.damping, g.rotational_stiffness, g.rotational_damping};
  }
  void step(const DeviceReport& hand, WaterStep& out) {
    const HandleInput input{hand.pose, hand.twist, true, 1.0};
    world_.step({&input, 1});
    world_.fill(now_);
    models_.after_step(world_, now_, wanted_, out_);
    const BodyState& body = now_.bodies[body_];
    out.motion = {body.center_of_mass, body.pose.orientation, body.twist};
    out.handle = now_.grips[0].handle;
    out.on_hand = now_.grips[0].on_hand;
    out.fluid = body.fluid;
    out.has_model = !out_.empty();
    if (out.has_model) out.model = out_.front();
  }

 private:
  static Plan plan_of(const Scene& scene, double spacing) {
    Plan plan = make_plan(scene, spacing);
    plan.sub_steps = 1;
    plan.time_step = kWaterPeriod;
    plan.max_speed = speed_limit(plan, kWaterPeriod);
    return plan;
  }
  const Scene& scene_;
  World world_;
  FluidModels models_;
  std::vector<char> wanted_;
  std::size_t body_;
  Pose start_;
  BodySnapshot now_;
  std::vector<FluidWrenchModel> out_;
};

/// A site's end: a replica, a passivity controller, no limits.
class Site {
 public:
  Site(const WaterRun& run, const ReplicaTuning& tuning)
      : gains_(run.grip.gains), held_(run.body, {run.grip}, tuning) {
    own_[0].here = true;
  }
  void receive(const WaterStep& step, double now) {
    if (step.has_model) {
      FluidLoad load;
      load.d_pose = step.model.d_pose;
      load.d_velocity = step.model.d_velocity;
      load.added_mass = step.model.added_mass;
      load.trust_distance = step.model.trust_radius;
      load.trust_angle = step.model.trust_angle;
      held_.set_fluid(load);
    }
    const HostHand said{true, step.handle, step.on_hand, to_nanoseconds(step.time + kWaterPeriod) + 1,
                        true, 0.0};
    held_.receive({to_nanoseconds(now) + 1,
                   step.time + kWaterPeriod,
                   kWaterPeriod,
                   step.motion,
                   {&said, 1},
                   1.0,
                   true,
                   step.fluid});
  }
  Wrench tick(const DeviceReport& hand, double now) {
    own_[0].engaged = true;
    own_[0].handle = hand.pose;
    own_[0].twist = hand.twist;
    Wrench felt;
    if (held_.started()) {
      const GripState grip = held_.grip(0);
      felt = held_.limit(0, coupling_wrench_on_hand(gains_, hand.pose, hand.twist, grip.pose, grip.twist),
                         hand.pose, hand.twist, kWaterPeriod, kMaxDamping);
    }
    held_.sent(0, felt);
    held_.advance(own_, kWaterPeriod, to_nanoseconds(now + kWaterPeriod) + 1);
    return felt;
  }
  const HeldBody& held() const { return held_; }

 private:
  CouplingGains gains_;
  HeldBody held_;
  std::vector<OwnHand> own_{1};
};

/// A hand that goes where another went, with the velocity that it had there: a TrackDevice would have that
/// from the cubic through the places.
class WentDevice final : public Device {
 public:
  explicit WentDevice(const std::vector<DeviceReport>& went) : went_(went) {}
  DeviceReport read(const DeviceMoment& moment) override {
    return went_.at(static_cast<std::size_t>(std::lround(moment.time / kWaterPeriod)));
  }
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool gives_way() const override { return false; }
  bool goes_with_world() const override { return true; }
  std::string kind() const override { return "led again"; }

 private:
  const std::vector<DeviceReport>& went_;
};

Result<std::unique_ptr<Device>> hand_of(const WaterCase& c, const Pose& start) {
  PoseTrack track(keys_of(c, start), start);
  // A way that no force changes.
  if (c.grip.empty()) return std::unique_ptr<Device>(new TrackDevice(std::move(track), "led"));
  const Result<OperatorSettings> settings = parse_operator(c.grip);
  if (!settings) return settings.error();
  return std::unique_ptr<Device>(new OperatorDevice(std::move(track), settings.value()));
}

}  // namespace

WaterWay way_of(const WaterCase& c) {
  WaterWay way;
  if (c.way == 0) return way;
  std::mt19937 random(static_cast<unsigned>(c.way));
  const auto draw = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  way.reach = draw(0.015, 0.035);
  way.pace = draw(0.8, 1.8);
  const double angle = draw(-0.6, 0.6);
  way.along = {std::cos(angle), 0.2 * draw(-1.0, 1.0), std::sin(angle)};
  return way;
}

namespace {

using MakeHand = std::function<Result<std::unique_ptr<Device>>(const Pose& start)>;

Result<WaterRun> run_hand(const WaterCase& c, const MakeHand& make_hand, std::size_t ticks) {
  Result<Scene> scene = scene_of();
  if (!scene) return scene.error();
  const Result<SampledScene> sampled = sample_scene(scene.value(), c.spacing);
  if (!sampled) return sampled.error();
  Host host(scene.value(), sampled.value(), c.spacing);
  Result<std::unique_ptr<Device>> hand = make_hand(host.start());
  if (!hand) return hand.error();
  WaterRun run;
  run.c = c;
  const Body& body = scene.value().bodies[static_cast<std::size_t>(scene.value().grips[0].body)];
  run.body = {body.mass.mass, body.mass.inertia, body.mass.center_of_mass, false, scene.value().gravity};
  run.grip = {scene.value().grips[0].pose, host.gains()};
  run.steps.resize(ticks);
  for (std::size_t i = 0; i < run.steps.size(); ++i) {
    WaterStep& step = run.steps[i];
    step.time = kWaterPeriod * static_cast<double>(i);
    const DeviceReport report = hand.value()->read({step.time, kWaterPeriod});
    step.hand = report.pose;
    step.hand_twist = report.twist;
    step.felt = host.felt(report);
    hand.value()->write(step.felt);
    host.step(report, step);
  }
  return run;
}

}  // namespace

Result<WaterRun> run_water(const WaterCase& c) {
  return run_hand(
      c, [&](const Pose& start) { return hand_of(c, start); },
      static_cast<std::size_t>(std::lround(kWaterEnds / kWaterPeriod)));
}

Result<WaterRun> run_water_again(const WaterCase& c, const std::vector<DeviceReport>& went) {
  return run_hand(
      c, [&](const Pose&) { return Result<std::unique_ptr<Device>>(std::make_unique<WentDevice>(went)); },
      went.size());
}

Result<std::vector<Wrench>> feel_water(const WaterRun& reference, double round_trip,
                                       const ReplicaTuning& tuning, std::vector<DeviceReport>* went) {
  const auto way = static_cast<std::size_t>(std::lround(0.5 * round_trip / kWaterPeriod));
  std::vector<Wrench> felt(reference.steps.size());
  Site site(reference, tuning);
  if (reference.c.grip.empty()) {
    for (std::size_t i = 0; i < felt.size(); ++i) {
      const double now = kWaterPeriod * static_cast<double>(i);
      if (i >= 2 * way) site.receive(reference.steps[i - 2 * way], now);
      DeviceReport hand;
      hand.pose = reference.steps[i].hand;
      hand.twist = reference.steps[i].hand_twist;
      felt[i] = site.held().started() ? site.tick(hand, now) : reference.steps[i].felt;
    }
    return felt;
  }
  Result<Scene> scene = scene_of();
  if (!scene) return scene.error();
  const Result<SampledScene> sampled = sample_scene(scene.value(), reference.c.spacing);
  if (!sampled) return sampled.error();
  Host host(scene.value(), sampled.value(), reference.c.spacing);
  Result<std::unique_ptr<Device>> hand = hand_of(reference.c, host.start());
  if (!hand) return hand.error();
  std::vector<DeviceReport> hands(felt.size());
  std::vector<WaterStep> steps(felt.size());
  for (std::size_t i = 0; i < felt.size(); ++i) {
    const double now = kWaterPeriod * static_cast<double>(i);
    hands[i] = hand.value()->read({now, kWaterPeriod});
    // The host hears of it a way later, and is heard of a way later again.
    if (i >= way) {
      steps[i].time = kWaterPeriod * static_cast<double>(i - way);
      host.step(hands[i - way], steps[i]);
    }
    if (i >= 2 * way) site.receive(steps[i - way], now);
    felt[i] = site.held().started() ? site.tick(hands[i], now) : reference.steps[i].felt;
    hand.value()->write(felt[i]);
  }
  if (went) *went = std::move(hands);
  return felt;
}

double water_force(const WaterRun& reference, double begin, double end) {
  const glm::dvec3 rest = reference.steps.front().felt.force;
  double all = 0.0, count = 0.0;
  for (const WaterStep& step : reference.steps) {
    if (step.time < begin || step.time >= end) continue;
    all += glm::dot(step.felt.force - rest, step.felt.force - rest);
    count += 1.0;
  }
  return std::sqrt(all / std::max(count, 1.0));
}

double water_error(const std::vector<Wrench>& felt, const WaterRun& reference, double begin, double end) {
  double off = 0.0, count = 0.0;
  for (std::size_t i = 0; i < std::min(felt.size(), reference.steps.size()); ++i) {
    const WaterStep& step = reference.steps[i];
    if (step.time < begin || step.time >= end) continue;
    off += glm::dot(felt[i].force - step.felt.force, felt[i].force - step.felt.force);
    count += 1.0;
  }
  const double all = water_force(reference, begin, end);
  return all > 0.0 ? std::sqrt(off / std::max(count, 1.0)) / all : 0.0;
}

double late_error(const WaterRun& reference, double round_trip) {
  const auto late = static_cast<std::size_t>(std::lround(round_trip / kWaterPeriod));
  std::vector<Wrench> felt;
  for (std::size_t i = 0; i < reference.steps.size(); ++i)
    felt.push_back(reference.steps[i - std::min(i, late)].felt);
  return water_error(felt, reference);
}

}  // namespace slosh::coupling
