// A guided task: what a person is asked to do, step by step, and how the world tells that it is done
// (TASKS.md).
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace slosh {

struct Scene;

/// What is measured, or how goals are put together.
enum class GoalKind : std::uint8_t {
  kMass,         ///< kg of fluid in a region
  kTemperature,  ///< °C, mean of the fluid in a region
  kSet,          ///< 0–1, how far the fluid in a region has set, mean
  kSpread,       ///< m² that the fluid in a region covers, seen along up (sim/fluid_measures.h)
  kEvenness,     ///< 0–1, of its depth there
  kMixing,       ///< 0–1, of one fluid among all in a region: Lacey's index
  kLevel,        ///< m along up, at a gauge
  kTilt,         ///< degrees between a body's up, which is up at the start, and up
  kSpeed,        ///< m/s of a body's centre of mass
  kDistance,     ///< m between two bodies' centres of mass
  kForce,        ///< N on a hand
  kAll,          ///< every part is met
  kAny,          ///< some part is
  kNot,          ///< its one part is not
  kPieces,       ///< how many of a body's pieces are in the world, itself among them
};
/// Whether it is put together from others.
constexpr bool of_parts(GoalKind kind) {
  return kind == GoalKind::kAll || kind == GoalKind::kAny || kind == GoalKind::kNot;
}

struct Goal {
  GoalKind kind = GoalKind::kAll;
  std::string name;  ///< of the region, gauge, body or grip that is measured
  int thing = -1;    ///< index of it into the scene's list of these
  int other = -1;    ///< kDistance: the other body; of a region: index into Scene::fluids, −1 = all
  double at_least = -std::numeric_limits<double>::infinity();
  double at_most = std::numeric_limits<double>::infinity();
  std::vector<Goal> parts;  ///< of kAll, kAny, kNot

  bool operator==(const Goal&) const = default;
};

enum class TaskActKind : std::uint8_t {
  kAppears,    ///< a body or fluid comes (World::appear)
  kTakesAway,  ///< it goes (World::take_away)
  kHandTakes,  ///< the hand that holds one grip lets go and takes another
};

/// What happens when a step is done.
struct TaskAct {
  TaskActKind kind = TaskActKind::kAppears;
  int thing = -1;  ///< by number (thing_name); kHandTakes: index of the grip that is let go
  int other = -1;  ///< kHandTakes: index of the grip that is taken; kTakesAway of a fluid volume: of the
                   ///< region in which it goes, −1 = everywhere

  bool operator==(const TaskAct&) const = default;
};

struct TaskStep {
  std::string say;    ///< one sentence for the person
  std::string hint;   ///< shown where the step takes longer than hint_after; may be empty
  Goal until;         ///< when it is done
  double hold = 0.0;  ///< s that the goal has to hold on
  double within =
      0.0;  ///< s that it should take; 0 = as long as it takes. Later it is done all the same, and late
  double hint_after = 10.0;  ///< s
  std::vector<TaskAct> then{};

  bool operator==(const TaskStep&) const = default;
};

/// A hand that lets one grip go and takes another, by their numbers.
struct HandMove {
  std::uint32_t from = 0, to = 0;
  bool operator==(const HandMove&) const = default;
};

/// Where a task is, as a person reads it; all empty without one.
struct TaskLines {
  std::string title;  ///< "step 2 of 5"
  std::string say;
  std::string now;              ///< what is measured, against what is wanted
  std::string hint;             ///< empty before its time, or why something has still to wait
  std::vector<HandMove> hands;  ///< that finished steps asked for, in order
  std::uint32_t done = 0;       ///< steps that are
  bool operator==(const TaskLines&) const = default;
};

/// Those that measure something, in order.
std::vector<const Goal*> leaves_of(const Goal& goal);

/// Whether it measures the fluid in a region.
constexpr bool of_region(GoalKind kind) {
  return kind <= GoalKind::kMixing;
}

inline constexpr std::size_t kMaxTaskSteps = 100;
inline constexpr std::size_t kMaxGoalParts = 32;  ///< of one goal
inline constexpr std::size_t kMaxTaskActs = 32;   ///< of one step
inline constexpr int kDeepestGoal = 8;            ///< goals within goals

/// "at least 0.15 kg", for people.
std::string limits_in_words(const Goal& goal);
/// "fluid in pan_inside: at least 0.15 kg", for people.
std::string in_words(const Goal& goal, const Scene& scene);
/// "butter appears", for people.
std::string in_words(const TaskAct& act, const Scene& scene);
/// Of a goal that measures something, what that is: "fluid in pan_inside".
std::string measured_in_words(const Goal& goal, const Scene& scene);
/// Of what a kind measures: "kg"; empty for shares, and for goals of parts.
const char* unit_of(GoalKind kind);

}  // namespace slosh
