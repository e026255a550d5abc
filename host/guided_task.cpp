#include "host/guided_task.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/fluid_measures.h"

namespace slosh {
namespace {

constexpr double kRounding = 1e-9;  // s

bool asks_for_fluid(const Goal& goal) {
  return of_region(goal.kind) || goal.kind == GoalKind::kLevel ||
         std::ranges::any_of(goal.parts, asks_for_fluid);
}

bool asks_for_heat(const Goal& goal) {
  return goal.kind == GoalKind::kTemperature || goal.kind == GoalKind::kSet ||
         std::ranges::any_of(goal.parts, asks_for_heat);
}

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

}  // namespace

GuidedTask::GuidedTask(const Scene& scene, const SampledScene& sampled)
    : scene_(scene), instruments_(scene, sampled) {
  if (const double g = glm::length(scene.gravity); g > 0.0) up_ = -scene.gravity / g;
}

double GuidedTask::measure_region(const Goal& goal) const {
  if (goal.kind == GoalKind::kMass)
    return goal.other < 0 ? fluid_->masses[at(goal.thing)]
                          : fluid_->fluid_masses[at(goal.thing) * scene_.fluids.size() + at(goal.other)];
  const Snapshot& now = instruments_.picture();
  std::vector<glm::vec3> places;
  std::vector<std::uint8_t> of_it;
  double sum = 0.0, weights = 0.0;
  for (const std::uint32_t i : instruments_.inside(at(goal.thing))) {
    const std::size_t fluid = now.fluid_index[i];
    const bool is_it = goal.other < 0 || fluid == at(goal.other);
    if (goal.kind == GoalKind::kMixing) of_it.push_back(is_it);
    if (!is_it && goal.kind != GoalKind::kMixing) continue;
    places.push_back(now.positions[i]);
    if (temperatures_.empty()) continue;
    // Of a mixture that which all of it would come to.
    const Fluid& of = scene_.fluids[fluid];
    const bool warmth = goal.kind == GoalKind::kTemperature;
    const double weight = of.rest_density * (warmth ? of.heat.capacity : 1.0);
    sum += weight * static_cast<double>((warmth ? temperatures_ : cures_)[i]);
    weights += weight;
  }
  switch (goal.kind) {
    case GoalKind::kSpread:
      return spread_of(places, up_, instruments_.spacing()).area;
    case GoalKind::kEvenness:
      return spread_of(places, up_, instruments_.spacing()).evenness;
    case GoalKind::kMixing:
      return mixing_index(places, of_it, instruments_.spacing());
    default:
      return sum / weights;  // no number where there is no fluid
  }
}

double GuidedTask::pieces_of(int body) const {
  double there = 0.0;
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    const bool of_it = static_cast<int>(b) == body || scene_.bodies[b].piece_of == body;
    if (of_it && !bodies_.bodies[b].gone) there += 1.0;
  }
  return there;
}

double GuidedTask::measure(const Goal& goal) const {
  if (of_region(goal.kind)) return measure_region(goal);
  switch (goal.kind) {
    case GoalKind::kLevel:
      return fluid_->levels[at(goal.thing)];
    case GoalKind::kTilt: {
      const glm::dquat turned = bodies_.bodies[at(goal.thing)].pose.orientation *
                                glm::conjugate(scene_.bodies[at(goal.thing)].pose.orientation);
      return glm::degrees(std::acos(std::clamp(glm::dot(turned * up_, up_), -1.0, 1.0)));
    }
    case GoalKind::kSpeed:
      return glm::length(bodies_.bodies[at(goal.thing)].twist.linear);
    case GoalKind::kDistance:
      return glm::distance(bodies_.bodies[at(goal.thing)].center_of_mass,
                           bodies_.bodies[at(goal.other)].center_of_mass);
    case GoalKind::kPieces:
      return pieces_of(goal.thing);
    case GoalKind::kForce:
      return glm::length(bodies_.grips[at(goal.thing)].on_hand.force);
    default:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

bool GuidedTask::met(const Goal& goal) const {
  const auto is_met = [this](const Goal& part) { return met(part); };
  if (goal.kind == GoalKind::kAll) return std::ranges::all_of(goal.parts, is_met);
  if (goal.kind == GoalKind::kAny) return std::ranges::any_of(goal.parts, is_met);
  if (goal.kind == GoalKind::kNot) return !met(goal.parts.front());
  const double value = measure(goal);
  return value >= goal.at_least && value <= goal.at_most;  // NaN is neither
}

const Goal* GuidedTask::asked_of(const Goal& goal) const {
  if (goal.parts.empty()) return &goal;
  if (goal.kind == GoalKind::kAll) {
    const auto open = std::ranges::find_if(goal.parts, [this](const Goal& part) { return !met(part); });
    return asked_of(open == goal.parts.end() ? goal.parts.front() : *open);
  }
  return asked_of(goal.parts.front());
}

double GuidedTask::spilled(const World& world) {
  const Measurement& now = instruments_.measure(world);
  const Snapshot& picture = instruments_.picture();
  std::vector<char> kept(picture.fluid_index.size(), 0);
  for (std::size_t r = 0; r < scene_.regions.size(); ++r)
    for (const std::uint32_t i : instruments_.inside(r)) kept[i] = 1;
  const double volume = std::pow(instruments_.spacing(), 3);
  double mass = 0.0;
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (!kept[i] && picture.fluid_index[i] != 255)
      mass += volume * scene_.fluids[picture.fluid_index[i]].rest_density;
  if (now.fluid.particles > 0)
    mass +=
        static_cast<double>(now.fluid.retired) * now.fluid.mass / static_cast<double>(now.fluid.particles);
  return mass;
}

void GuidedTask::look(const World& world) {
  const TaskStep& step = scene_.task[state_.done.size()];
  world.fill(bodies_);
  if (asks_for_fluid(step.until)) fluid_ = &instruments_.measure(world);
  temperatures_.clear();
  if (asks_for_heat(step.until)) world.fill_heat(temperatures_, cures_);
  state_.asked = asked_of(step.until);
  state_.measured = measure(*state_.asked);
  const bool is_met = met(step.until);
  state_.held = is_met && was_met_ ? state_.held + (world.time() - state_.now) : 0.0;
  was_met_ = is_met;
  state_.now = world.time();
  if (!is_met || state_.held + kRounding < step.hold) return;
  const double took = state_.now - state_.begun;
  state_.done.push_back({took, step.within > 0.0 && took > step.within});
  for (const Goal* leaf : leaves_of(step.until)) state_.done.back().measured.push_back(measure(*leaf));
  state_.begun = state_.now;
  state_.held = 0.0;
  state_.asked = nullptr;
  was_met_ = false;
}

void GuidedTask::carry_on(const std::vector<double>& took) {
  carried_.clear();
  for (std::size_t i = 0; i < std::min(took.size(), scene_.task.size()); ++i)
    carried_.push_back({took[i], scene_.task[i].within > 0.0 && took[i] > scene_.task[i].within});
}

bool GuidedTask::follow(const World& world) {
  const double time = world.time();
  if (!begun_ || time < state_.now - kRounding) {
    state_ = {};
    state_.begun = state_.now = next_ = time;
    state_.done = std::exchange(carried_, {});
    begun_ = true;
    was_met_ = false;
  }
  if (time + kRounding < next_ || state_.done.size() == scene_.task.size()) return false;
  next_ = kEvery * (std::floor((time + kRounding) / kEvery) + 1.0);
  look(world);
  return true;
}

}  // namespace slosh
