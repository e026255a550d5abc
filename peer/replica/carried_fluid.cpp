#include "peer/replica/carried_fluid.h"

#include <numbers>

namespace slosh {
namespace {

constexpr double kMaxSlosh = 4.0;    // times the body's mass: no more of its fluid swings
constexpr double kMinCarried = 0.1;  // times the body's mass: less in it is not looked at
constexpr double kWater = 1000.0;    // kg/m³: what is carried is taken to be about as dense
/// A round vessel filled as deep as half its width (Abramson 1966): the share of it that swings, and R·ω²/g.
constexpr double kSwings = 0.43;
constexpr double kQuick = 1.841 * 0.951;
/// s, or quickest_followed(), over which it is weighed, and the share of it by which that goes to and fro as
/// it swings.
constexpr double kWeighed = 0.1;
constexpr double kOff = 0.06;
constexpr double kMinWeighing = 1.0;  // m²/s⁴: what falls with its fluid does not weigh it
constexpr double kPoured = 0.03;      // s, in which it changes by a factor of e at most
constexpr double kVesselKnown = 0.2;  // s
/// s of round trip at which half of what does not last is followed of what acts on a body that carries
/// nothing.
constexpr double kLate = 0.03;
/// Of its weight, what no model explains goes on by this much at most.
constexpr double kMaxGoesOn = 0.3;
/// s and N²·s: over which, and against how much before anything was seen, it is found how far a bowl explains
/// what the fluid does upwards. As steep as it gets a surface breaks.
constexpr double kLiftMemory = 1.0;
constexpr double kSureOfLift = 1.0;

}  // namespace

void CarriedFluid::restart() noexcept {
  for (SloshFinder& finder : finders_) finder.restart(kMaxSlosh * body_.mass);
  for (ResidueFollower& residue : residue_) residue.restart();
  down_ = passing_ = dragged_ = glm::dvec3(0.0);
  mass_force_ = mass_square_ = carried_ = vessel_ = round_trip_ = 0.0;
  bowl_ = lifts_ = lifts_square_ = lifts_answer_ = foreseen_ = 0.0;
  lifts_share_ = 1.0;
}

void CarriedFluid::update(const Acting& acting) noexcept {
  if (acting.elapsed > 0.0) {
    const glm::dvec3 force = acting.tells_fluid ? acting.fluid : acting.force;
    for (int i = 0; i < 3; ++i) {
      SloshFinder& finder = finders_[static_cast<std::size_t>(i)];
      finder.tell(acting.told_mass[i], acting.told_drag[i]);
      finder.add_sample(acting.elapsed, acting.before[i], acting.now[i],
                        force[i] - lifts_share_ * lifts_ * down_[i]);
    }
    const double keep = std::exp(-acting.elapsed / kLiftMemory);
    lifts_square_ = keep * lifts_square_ + acting.elapsed * lifts_ * lifts_;
    lifts_answer_ = keep * lifts_answer_ + acting.elapsed * lifts_ * glm::dot(passing_, down_);
    lifts_share_ = std::clamp((lifts_answer_ + kSureOfLift) / (lifts_square_ + kSureOfLift), 0.0, 1.0);
  }
  look_for_vessel(acting);
}

/// By what weighs and is accelerated: a vessel that is thrown up weighs no more by that.
void CarriedFluid::weigh(const Acting& acting) noexcept {
  const bool known = acting.elapsed > 0.0;
  const glm::dvec3 weighs =
      body_.gravity - (known ? (acting.now - acting.before) / acting.elapsed : glm::dvec3(0.0));
  const double keep = known && mass_square_ > 0.0
                          ? std::exp(-acting.elapsed / std::max(kWeighed, quickest_followed(round_trip_)))
                          : 0.0;
  mass_force_ = keep * mass_force_ + (1.0 - keep) * glm::dot(acting.fluid - dragged_, weighs);
  mass_square_ = keep * mass_square_ + (1.0 - keep) * glm::dot(weighs, weighs);
  const double mass = mass_force_ / std::max(mass_square_, kMinWeighing);
  const double least = kMinCarried * body_.mass;
  if (carried_ > 0.0) {
    const double most = std::exp(acting.elapsed / kPoured);
    const double before = carried_;
    carried_ = std::clamp(carried_, mass / (1.0 + kOff), std::max(mass, 0.0) / (1.0 - kOff));
    carried_ = std::clamp(carried_, before / most, before * most);
    if (mass < least) carried_ = 0.0;
    if (carried_ > 0.0 && carried_ != before)
      for (SloshFinder& finder : finders_) finder.lighten(carried_ / before);
    return;
  }
  glm::dvec3 lasting = acting.fluid;
  for (int i = 0; i < 3; ++i)
    if (const ResidueFollower& residue = residue_[static_cast<std::size_t>(i)]; residue.known())
      lasting[i] = residue.lasting();
  // What is dragged weighs for a moment.
  if (std::min(mass, glm::dot(lasting, body_.gravity) / glm::dot(body_.gravity, body_.gravity)) > least)
    carried_ = mass;
}

void CarriedFluid::look_for_vessel(const Acting& acting) noexcept {
  const double g = glm::length(body_.gravity);
  down_ = glm::dvec3(0.0);
  bowl_ = 0.0;
  if (!acting.tells_fluid || !(g > 0.0)) return;
  weigh(acting);
  const double mass = carried_;
  if (!(mass > 0.0)) return;
  const glm::dvec3 down = body_.gravity / g;
  down_ = down;
  bowl_ = 1.0 / g;
  const double radius = std::cbrt(mass / (std::numbers::pi * kWater));
  for (int i = 0; i < 3; ++i) {
    const double level = 1.0 - down[i] * down[i];
    finders_[static_cast<std::size_t>(i)].expect((1.0 - kSwings * level) * mass, kSwings * level * mass,
                                                 std::sqrt(kQuick * g / radius));
  }
}

void CarriedFluid::put_into(FluidLoad& load, Vector6& rest, const Vector6& pace, const Acting& acting,
                            double share, double round_trip) noexcept {
  load.bowl = share * lifts_share_ * bowl_ * down_;
  Vector6 kept{1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  for (std::size_t i = 0; i < 3; ++i) kept[i] = std::sqrt(1.0 - share * finders_[i].share());
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) {
      const double both = kept[i] * kept[j];
      load.added_mass[i][j] *= both;
      load.d_velocity[i][j] *= both;
      load.d_pose[i][j] *= both;
    }
  lifts_ = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double followed = share * finders_[i].share();
    load.added_mass[i][i] += followed * finders_[i].rigid();
    load.d_velocity[i][i] -= followed * finders_[i].drag();
    load.swings[i] = finders_[i].mode();
    load.swings[i].mass *= followed;
    rest[i] -= slosh_force(load.swings[i], finders_[i].state());
    const double lifts = bowl_force(load.swings[i], finders_[i].state(), pace[i]);
    lifts_ += bowl_ * lifts;
    for (std::size_t j = 0; j < 3; ++j) rest[j] -= lifts * load.bowl[static_cast<int>(j)];
  }
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) rest[i] += load.added_mass[i][j] * pace[j];
  if (!acting.tells_fluid) return;
  // A vessel's residue is foreseen; that of a body in fluid is followed as it comes, but for what would be
  // late.
  const double most = acting.elapsed / kVesselKnown;
  vessel_ += residue_[0].known() ? std::clamp((carried_ > 0.0 ? 1.0 : 0.0) - vessel_, -most, most)
                                 : (carried_ > 0.0 ? 1.0 : 0.0) - vessel_;
  const double late = round_trip / kLate,
               left_out = share * (1.0 - vessel_) * (1.0 - 1.0 / (1.0 + late * late));
  load.foreseen = share * vessel_;
  foreseen_ = load.foreseen + left_out;
  round_trip_ = round_trip;
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    double still = rest[row] - (acting.force[i] - acting.fluid[i]);
    dragged_[i] = 0.0;
    for (int j = 0; j < 3; ++j)
      dragged_[i] += load.d_velocity[row][static_cast<std::size_t>(j)] * acting.now[j];
    still -= dragged_[i];
    ResidueFollower& residue = residue_[row];
    load.late[i] = still;
    if (acting.elapsed > 0.0) {
      residue.update(acting.elapsed, still, round_trip + kGoesOnTaken,
                     kMaxGoesOn * carried_ * glm::length(body_.gravity));
      const double passing = still - residue.lasting();
      passing_[i] = passing + lifts_share_ * lifts_ * down_[i];
      load.late[i] -= left_out * passing;
      rest[row] -= left_out * passing;
    }
    load.goes_on[i] = residue.known() ? residue.foreseen() : still;
  }
}

}  // namespace slosh
