#include "host/server/effect_budget.h"

#include <algorithm>
#include <cmath>

#include "net/clock.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

/// One guest's budget; all guests together have `all` times as much.
struct Kind {
  const char* done;  // "… as one guest may"
  double rate;       // a second
  double burst;
  double all;
  double least;  // what the smallest change counts
};

// Two jumps of gravity between its ends, or of a stiffness, then one each 10 and each 6 s. In units of a
// pause, a reset, the scene's gravity, a factor of ten of viscosity, a doubling of stiffness.
constexpr Kind kKindTable[] = {{"paused the world or let it go on as often", 0.5, 6.0, 2.0, 1.0},
                               {"set the world back as often", 0.1, 2.0, 2.0, 1.0},
                               {"changed gravity as much", 0.2, 4.0, 2.0, 0.05},
                               {"changed viscosities as much", 1.0, 12.0, 2.0, 0.05},
                               {"changed the stiffness of grips as much", 1.0, 13.0, 4.0, 0.05}};
constexpr double kSettled = 1.0;         // s until the world has what it was asked for
constexpr double kMinViscosity = 1e-4;   // Pa·s: less viscous fluids feel alike
constexpr double kMaxOfViscosity = 4.0;  // what one change counts at most: the world may refuse it
constexpr std::size_t kMaxAtEase = 64;   // guests before those whose budgets are full are forgotten
constexpr double kFullAgain = 60.0;      // s

std::size_t kind_of(HostAction action) {
  switch (action) {
    case HostAction::kPause:
    case HostAction::kContinue:
      return 0;
    case HostAction::kReset:
      return 1;
    case HostAction::kGravityScale:
      return 2;
    case HostAction::kViscosity:
      return 3;
    case HostAction::kGripStiffness:
    case HostAction::kAppear:  // these two a guest cannot ask for
    case HostAction::kTakeAway:
      break;
  }
  return 4;
}

double distance(HostAction action, double from, double to) {
  switch (action) {
    case HostAction::kGravityScale:
      return std::abs(to - from);
    case HostAction::kViscosity:
      return std::min(kMaxOfViscosity,
                      std::abs(std::log10(std::max(to, kMinViscosity) / std::max(from, kMinViscosity))));
    case HostAction::kGripStiffness:
      return std::abs(std::log2(std::clamp(to, wire::kMinGripStiffness, wire::kMaxGripStiffness) /
                                std::clamp(from, wire::kMinGripStiffness, wire::kMaxGripStiffness)));
    default:
      return 0.0;
  }
}

/// The value that a command changes, as it is; its own where the world has none.
double value_now(const HostCommand& command, const HostState& now) {
  const auto of = [&](const std::vector<double>& values) {
    return command.index < values.size() ? values[command.index] : command.value;
  };
  switch (command.action) {
    case HostAction::kGravityScale:
      return now.gravity_scale;
    case HostAction::kViscosity:
      return of(now.viscosities);
    case HostAction::kGripStiffness:
      return of(now.grip_stiffness);
    default:
      return command.value;
  }
}

std::vector<TokenBucket> buckets(bool all) {
  std::vector<TokenBucket> made;
  for (const Kind& kind : kKindTable) {
    const double times = all ? kind.all : 1.0;
    made.emplace_back(times * kind.rate, times * kind.burst);
  }
  return made;
}

std::string when(double seconds) {
  return format("again in %.0f s", std::max(1.0, std::ceil(seconds)));
}

}  // namespace

EffectBudget::EffectBudget() : all_(buckets(true)) {}

double EffectBudget::size_of(const HostCommand& command, const HostState& now, std::int64_t now_ns) const {
  double size = distance(command.action, value_now(command, now), command.value);
  const auto asked = asked_.find({command.action, command.index});
  if (asked != asked_.end() && to_seconds(now_ns - asked->second.at_ns) < kSettled)
    size = std::max(size, distance(command.action, asked->second.value, command.value));
  return std::max(size, kKindTable[kind_of(command.action)].least);
}

EffectBudget::Guest& EffectBudget::guest(const KeyFingerprint& who, std::int64_t now_ns) {
  if (guests_.size() > kMaxAtEase) {
    std::erase_if(guests_, [&](const auto& each) {
      return to_seconds(now_ns - each.second.used_ns) > kFullAgain && each.first != who;
    });
  }
  Guest& guest = guests_[who];
  if (guest.buckets.empty()) guest.buckets = buckets(false);
  guest.used_ns = now_ns;
  return guest;
}

std::string EffectBudget::spend(const KeyFingerprint& who, const HostCommand& command, const HostState& now,
                                std::int64_t now_ns) {
  const std::size_t kind = kind_of(command.action);
  const double size = size_of(command, now, now_ns);
  TokenBucket& own = guest(who, now_ns).buckets[kind];
  TokenBucket& all = all_[kind];
  if (const double wait = own.wait(now_ns, size); wait > 0.0)
    return format("you have %s as one guest may for now: ", kKindTable[kind].done) + when(wait);
  if (const double wait = all.wait(now_ns, size); wait > 0.0)
    return format("the guests have together %s as they may for now: ", kKindTable[kind].done) + when(wait);
  own.take(now_ns, size);
  all.take(now_ns, size);
  asked_[{command.action, command.index}] = {command.value, now_ns};
  return {};
}

}  // namespace slosh
