#include "peer/haptics/replica/carried_fluid.h"

#include <numbers>

namespace slosh {
namespace {

constexpr double kMostSlosh = 4.0;     // times the body's mass: no more of its fluid swings
constexpr double kLeastCarried = 0.1;  // times the body's mass: less in it is not looked at
constexpr double kWater = 1000.0;      // kg/m³: what is carried is taken to be about as dense
/// A round vessel filled as deep as half its width (Abramson 1966): the share of it that swings, and R·ω²/g.
constexpr double kSwings = 0.43;
constexpr double kQuick = 1.841 * 0.951;
constexpr double kLasts = 1.0;  // s, after which what no model explains is taken to last
/// s to one side, which is longer than what swings stays there, from which on weight is taken to be poured
/// out or in; s over which it is then believed; and the share of the weight that counts as off.
constexpr double kOneWay = 0.5;
constexpr double kPoured = 0.1;
constexpr double kOff = 0.06;
/// s of round trip at which half of what does not last is followed.
constexpr double kLate = 0.03;
/// s and N²·s: over which, and against how much before anything was seen, it is found how far a bowl explains
/// what the fluid does upwards. As steep as it gets a surface breaks.
constexpr double kLiftMemory = 1.0;
constexpr double kSureOfLift = 1.0;

}  // namespace

void CarriedFluid::restart() noexcept {
  for (SloshFinder& finder : finders_) finder.restart(kMostSlosh * body_.mass);
  down_ = lasting_ = passing_ = one_way_ = glm::dvec3(0.0);
  weight_ = 0.0;
  bowl_ = lifts_ = lifts_square_ = lifts_answer_ = foreseen_ = 0.0;
  lifts_share_ = 1.0;
  lasting_known_ = false;
}

void CarriedFluid::hear(const Acting& acting) noexcept {
  if (acting.elapsed > 0.0) {
    const glm::dvec3 force = acting.tells_fluid ? acting.fluid : acting.force;
    for (int i = 0; i < 3; ++i)
      finders_[static_cast<std::size_t>(i)].hear(acting.elapsed, acting.before[i], acting.now[i],
                                                 force[i] - lifts_share_ * lifts_ * down_[i]);
    const double keep = std::exp(-acting.elapsed / kLiftMemory);
    lifts_square_ = keep * lifts_square_ + acting.elapsed * lifts_ * lifts_;
    lifts_answer_ = keep * lifts_answer_ + acting.elapsed * lifts_ * glm::dot(passing_, down_);
    lifts_share_ = std::clamp((lifts_answer_ + kSureOfLift) / (lifts_square_ + kSureOfLift), 0.0, 1.0);
  }
  look_for_vessel(acting);
}

void CarriedFluid::look_for_vessel(const Acting& acting) noexcept {
  const double g = glm::length(body_.gravity);
  down_ = glm::dvec3(0.0);
  bowl_ = 0.0;
  if (!acting.tells_fluid || !(g > 0.0)) return;
  const glm::dvec3 down = body_.gravity / g;
  const double mass = glm::dot(lasting_known_ ? lasting_ : acting.fluid, down) / g;
  if (!(mass > kLeastCarried * body_.mass)) return;
  down_ = down;
  weight_ = mass * g;
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
  if (!(acting.elapsed > 0.0) || !acting.tells_fluid) return;
  const double late = round_trip / kLate;
  foreseen_ = share * (1.0 - 1.0 / (1.0 + late * late));
  const double lasts = 1.0 - std::exp(-acting.elapsed / kLasts);
  const double poured = 1.0 - std::exp(-acting.elapsed / kPoured);
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    double still = rest[row] - (acting.force[i] - acting.fluid[i]);
    for (int j = 0; j < 3; ++j) still -= load.d_velocity[row][static_cast<std::size_t>(j)] * acting.now[j];
    const double off = lasting_known_ ? still - lasting_[i] : 0.0;
    const bool weighs = std::abs(down_[i]) > 0.7 && std::abs(off) > kOff * weight_;
    if (!weighs || off * one_way_[i] < 0.0) one_way_[i] = 0.0;
    if (weighs) one_way_[i] += std::copysign(acting.elapsed, off);
    const double soon = std::abs(one_way_[i]) > kOneWay ? poured : lasts;
    lasting_[i] += (lasting_known_ ? soon : 1.0) * (still - lasting_[i]);
    passing_[i] = still - lasting_[i] + lifts_share_ * lifts_ * down_[i];
    rest[row] -= foreseen_ * (still - lasting_[i]);
  }
  lasting_known_ = true;
}

}  // namespace slosh
