// The scene's guided task: steps, goals, and what they name (TASKS.md).
#include <algorithm>

#include "net/text/clean.h"
#include "net/text/nearest.h"
#include "scenes/reading/reading.h"

namespace slosh::reading {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxWords = 300;  // bytes of a sentence or a hint

struct Measured {
  const char* key;
  GoalKind kind;
  const char* of;  // what it names
};
constexpr Measured kMeasured[] = {
    {"mass_kg", GoalKind::kMass, "region"},      {"temperature_c", GoalKind::kTemperature, "region"},
    {"set", GoalKind::kSet, "region"},           {"spread_m2", GoalKind::kSpread, "region"},
    {"evenness", GoalKind::kEvenness, "region"}, {"mixing", GoalKind::kMixing, "region"},
    {"level_m", GoalKind::kLevel, "gauge"},      {"tilt_deg", GoalKind::kTilt, "body"},
    {"speed_m_s", GoalKind::kSpeed, "body"},     {"distance_m", GoalKind::kDistance, "body"},
    {"force_n", GoalKind::kForce, "grip"},       {"pieces", GoalKind::kPieces, "body"},
};
struct Together {
  const char* key;
  GoalKind kind;
};
constexpr Together kTogether[] = {{"all", GoalKind::kAll}, {"any", GoalKind::kAny}, {"not", GoalKind::kNot}};

template <class Thing>
std::vector<std::string> names_of(const std::vector<Thing>& things) {
  std::vector<std::string> names;
  for (const Thing& thing : things) names.push_back(thing.name);
  return names;
}

/// "mass_kg, …, ".
std::string known_kinds() {
  std::string list;
  for (const Measured& measured : kMeasured) list += std::string(measured.key) + ", ";
  return list;
}

/// Index into `names`; −1, and an error, where there is none of that name.
int named(const std::string& name, const std::vector<std::string>& names, const std::string& what,
          const std::string& where, std::vector<Error>& errors) {
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  std::string list;
  for (const std::string& known : names) list += (list.empty() ? "" : ", ") + known;
  errors.push_back({where, "names the " + what + " '" + name + "', and there is none",
                    list.empty() ? "Give an object slosh = \"" + what + "\" and that name"
                                 : did_you_mean(name, names) + "Name one of: " + list});
  return -1;
}

/// What stands for good neither comes nor goes.
void check_comes(const Body& body, const std::string& where, std::vector<Error>& errors) {
  if (body.point_probe)
    errors.push_back({where, "is a probe, which stays", "Name a body with a mesh, or a fluid"});
  else if (!moves(body.motion))
    errors.push_back(
        {where, "'" + body.name + "' stands for good", "Give it motion = \"free\", or starts_away = true"});
}

/// Reads goals, and keeps what is wrong with them.
class Goals {
 public:
  explicit Goals(Reading& reading) : reading_(reading) {}

  Goal read(const json& value, const std::string& owner, int depth = 0) {
    Goal goal;
    if (!value.is_object()) {
      fail(owner, "is no goal", "Give one as {\"mass_kg\": \"pan_inside\", \"at_least\": 0.15}");
      return goal;
    }
    if (depth > kDeepestGoal) {
      fail(owner, "is within more than " + std::to_string(kDeepestGoal) + " other goals",
           "Put it together from fewer");
      return goal;
    }
    json own = value;
    for (const Together& together : kTogether) own.erase(together.key);
    gltf::Extras fields(own, owner);
    int kinds = 0;
    for (const Measured& measured : kMeasured) {
      if (!fields.has(measured.key)) continue;
      kinds += 1;
      goal.kind = measured.kind;
      goal.name = clean_text(fields.text(measured.key, ""), kMaxWords);
      goal.thing = find(goal.name, names_of(measured.kind), measured.of, owner + ": extras." + measured.key);
    }
    for (const Together& together : kTogether) {
      if (!value.contains(together.key)) continue;
      kinds += 1;
      goal.kind = together.kind;
      read_parts(value[together.key], owner + ": extras." + together.key, depth, goal);
    }
    if (kinds != 1) {
      fail(owner, kinds == 0 ? "says nothing that can be measured" : "says more than one thing to measure",
           "Give one of " + known_kinds() + "all, any, not; several goals go together by all or any");
      return goal;
    }
    if (!of_parts(goal.kind)) read_limits(fields, owner, goal);
    for (const std::vector<Error>& wrong : {fields.errors(), fields.foreign()})
      errors.insert(errors.end(), wrong.begin(), wrong.end());
    return goal;
  }

  std::vector<Error> errors;

 private:
  void fail(std::string where, std::string what, std::string mend) {
    errors.push_back({std::move(where), std::move(what), std::move(mend)});
  }

  std::vector<std::string> names_of(GoalKind kind) const {
    const Scene& scene = reading_.scene;
    if (of_region(kind)) return reading::names_of(scene.regions);
    if (kind == GoalKind::kLevel) return reading::names_of(scene.gauges);
    if (kind == GoalKind::kForce) return reading::names_of(scene.grips);
    return reading::names_of(scene.bodies);
  }

  int find(const std::string& name, const std::vector<std::string>& names, const std::string& what,
           const std::string& where) {
    return named(name, names, what, where, errors);
  }

  void read_parts(const json& parts, const std::string& owner, int depth, Goal& goal) {
    if (goal.kind == GoalKind::kNot) {
      goal.parts.push_back(read(parts, owner, depth + 1));
      return;
    }
    if (!parts.is_array() || parts.empty() || parts.size() > kMaxGoalParts) {
      fail(owner, "is no list of goals", "Give a list of 1 to " + std::to_string(kMaxGoalParts) + " goals");
      return;
    }
    for (std::size_t i = 0; i < parts.size(); ++i)
      goal.parts.push_back(read(parts[i], owner + "[" + std::to_string(i) + "]", depth + 1));
  }

  void read_limits(gltf::Extras& fields, const std::string& owner, Goal& goal) {
    if (fields.has("at_least")) goal.at_least = fields.number("at_least", 0.0, gltf::kAnyNumber);
    if (fields.has("at_most")) goal.at_most = fields.number("at_most", 0.0, gltf::kAnyNumber);
    if (!fields.has("at_least") && !fields.has("at_most"))
      fields.fail("at_least", "is missing, and at_most too",
                  "Give one of them, or both" +
                      (*unit_of(goal.kind) ? std::string(", in ") + unit_of(goal.kind) : std::string()));
    else if (goal.at_least > goal.at_most)
      fields.fail("at_least", "is above at_most", "Make it the smaller of the two");
    if (goal.kind == GoalKind::kMixing && !fields.has("fluid"))
      fields.fail("fluid", "is missing", "Name the fluid that is to be mixed in: one of the scene's");
    if (of_region(goal.kind) && fields.has("fluid"))
      goal.other = find(fields.text("fluid", ""), reading::names_of(reading_.scene.fluids), "fluid",
                        owner + ": extras.fluid");
    if (goal.kind == GoalKind::kPieces && goal.thing >= 0 &&
        reading_.scene.bodies[static_cast<std::size_t>(goal.thing)].pieces == 0)
      fields.fail("pieces", "names a body that cannot be cut", "Give '" + goal.name + "' pieces = 2 or more");
    if (goal.kind == GoalKind::kDistance)
      goal.other = find(fields.text("to", ""), names_of(GoalKind::kDistance), "body", owner + ": extras.to");
  }

  Reading& reading_;
};

struct ActField {
  const char* key;
  TaskActKind kind;
};
constexpr ActField kActFields[] = {{"appears", TaskActKind::kAppears},
                                   {"takes_away", TaskActKind::kTakesAway},
                                   {"hand", TaskActKind::kHandTakes}};

int region_of_fluid(const Scene& scene, const std::string& name, int thing, const std::string& where,
                    std::vector<Error>& errors) {
  if (thing >= 0 && static_cast<std::size_t>(thing) < scene.bodies.size())
    errors.push_back({where, "is given of a body, which goes as a whole", "Leave it out, or name a fluid"});
  return named(name, names_of(scene.regions), "region", where, errors);
}

/// What `then` lists, or the one thing that it is.
void read_acts(const Reading& reading, const json& step, const std::string& owner, std::vector<TaskAct>& acts,
               std::vector<Error>& errors) {
  if (!step.contains("then") || step["then"].is_null()) return;
  const Scene& scene = reading.scene;
  const json list = step["then"].is_array() ? step["then"] : json::array({step["then"]});
  if (list.size() > kMaxTaskActs)
    errors.push_back({owner + ": extras.then", "is a list of more than " + std::to_string(kMaxTaskActs),
                      "Share them out over several steps"});
  std::vector<std::string> things;
  for (std::size_t i = 0; i < thing_count(scene); ++i) things.push_back(thing_name(scene, i));
  const std::vector<std::string> grips = names_of(scene.grips);
  for (std::size_t i = 0; i < std::min(list.size(), kMaxTaskActs); ++i) {
    const std::string where = owner + ": extras.then[" + std::to_string(i) + "]";
    TaskAct act;
    int kinds = 0;
    if (list[i].is_object()) {
      gltf::Extras fields(list[i], where);
      for (const ActField& field : kActFields) {
        if (!fields.has(field.key)) continue;
        kinds += 1;
        act.kind = field.kind;
        const bool of_hand = field.kind == TaskActKind::kHandTakes;
        const std::string at = where + ": extras." + field.key;
        act.thing = named(fields.text(field.key, ""), of_hand ? grips : things,
                          of_hand ? "grip" : "body or fluid", at, errors);
        if (of_hand)
          act.other = named(fields.text("takes", ""), grips, "grip", where + ": extras.takes", errors);
        else if (field.kind == TaskActKind::kTakesAway && fields.has("in"))
          act.other = region_of_fluid(scene, fields.text("in", ""), act.thing, where + ": extras.in", errors);
        else if (act.thing >= 0 && static_cast<std::size_t>(act.thing) < scene.bodies.size())
          check_comes(scene.bodies[static_cast<std::size_t>(act.thing)], at, errors);
      }
      for (const std::vector<Error>& wrong : {fields.errors(), fields.foreign()})
        errors.insert(errors.end(), wrong.begin(), wrong.end());
    }
    if (kinds != 1)
      errors.push_back({where, "is nothing that can happen",
                        "Give one of {\"appears\": \"butter\"}, {\"takes_away\": \"bowl\"}, "
                        "{\"hand\": \"whisk\", \"takes\": \"spatula\"}"});
    acts.push_back(act);
  }
}

}  // namespace

Problem read_task(Reading& reading) {
  const json& extras = reading.document.scene_extras;
  if (!extras.contains("task") || extras["task"].is_null()) return std::nullopt;
  const std::string owner = reading.document.file + ": scene: extras.task";
  json steps = extras["task"];
  // Blender's panel for custom properties has no lists of groups, but texts.
  if (steps.is_string()) {
    steps = json::parse(steps.get<std::string>(), nullptr, false);
    if (steps.is_discarded())
      return Error{owner, "is a text that is no JSON", "Write it as a list of steps (scenes/TASKS.md)"};
  }
  if (!steps.is_array() || steps.empty() || steps.size() > kMaxTaskSteps)
    return Error{owner, "is no list of steps",
                 "Give a list of 1 to " + std::to_string(kMaxTaskSteps) + " steps (scenes/TASKS.md)"};
  Goals goals(reading);
  Problem first;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::string where = owner + "[" + std::to_string(i) + "]";
    if (!steps[i].is_object()) {
      goals.errors.push_back({where, "is no step", "Give one as {\"say\": \"…\", \"until\": {…}}"});
      continue;
    }
    json own = steps[i];
    own.erase("then");  // a list, which Extras has none of
    gltf::Extras fields(own, where);
    TaskStep step;
    step.say = clean_text(fields.text("say", ""), kMaxWords);
    step.hint = clean_text(fields.text("hint", ""), kMaxWords);
    step.hold = fields.number("hold_s", 0.0, gltf::Range{0.0, 3600.0});
    step.within = fields.number("within_s", 0.0, gltf::Range{0.0, 86400.0});
    step.hint_after = fields.number("hint_after_s", step.hint_after, gltf::Range{0.0, 3600.0});
    if (step.say.empty())
      fields.fail("say", "is missing", "Give a sentence that tells the person what to do");
    const json* until = fields.object("until");
    read_acts(reading, steps[i], where, step.then, goals.errors);
    if (until)
      step.until = goals.read(*until, where + ": extras.until");
    else
      fields.fail("until", "is missing",
                  "Give the goal that ends the step, as {\"mass_kg\": \"pan_inside\", \"at_least\": 0.15}");
    first = all_of(reading, first, fields);
    reading.scene.task.push_back(std::move(step));
  }
  for (Error& error : goals.errors) {
    if (first)
      reading.further.push_back(std::move(error));
    else
      first = std::move(error);
  }
  return first;
}

}  // namespace slosh::reading
