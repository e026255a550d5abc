// Joints between bodies, and the keys of driven ones.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "net/text/clean.h"
#include "net/text/nearest.h"
#include "scenes/gltf/animation.h"
#include "scenes/reading/reading.h"
#include "sim/math/limits.h"

namespace slosh::reading {
namespace {

using gltf::Extras;
using gltf::Range;

constexpr std::size_t kMaxBodyName = 300;  // bytes
constexpr double kMaxStopTurn = 36'000.0;  // degrees: a hundred turns
constexpr double kMaxStopWay = 1000.0;     // m
constexpr Range kMotorSpeed{-1000.0, 1000.0};
constexpr Range kJointForce{0.0, 1e6};
constexpr Range kBreaks{0.0, 1e6, true};
constexpr Range kJoinsWithin{0.0, 10.0, true};
constexpr Range kJoinsTurn{0.0, 180.0, true};
constexpr double kUsualJoinsTurn = 10.0;  // degrees
// By which the last of keys that repeat may be off the first, m and rad.
constexpr double kMeetsWay = 1e-3;
constexpr double kMeetsTurn = 1e-2;

/// What a hinge's and a slider's fields are called.
struct JointFields {
  const char *least, *most, *damping, *speed, *limit;
};
/// Only a fixed one's.
constexpr const char* kFixedFields[] = {"starts_apart", "joins_m", "joins_deg", "meets"};
constexpr JointFields kJointFields[] = {
    {"min_deg", "max_deg", "damping_nm_s_rad", "motor_rad_s", "motor_nm"},
    {"min_m", "max_m", "damping_n_s_m", "motor_m_s", "motor_n"},
};

Problem place_joint(Reading& reading, int node, Joint& joint) {
  const int up = body_node_above(reading, node);
  if (up < 0) {
    return Error{reading.document.owner(node), "is not the child of a body",
                 "Parent it to one of the two bodies that it joins (slosh = \"body\")"};
  }
  joint.body = reading.body_of_node[up];
  Pose body, world;
  glm::dmat3 rest;
  if (Problem problem = read_pose(reading, up, body, rest)) return problem;
  if (Problem problem = read_pose(reading, node, world, rest)) return problem;
  joint.pose = compose(inverse(body), world);
  return std::nullopt;
}

void read_other(const Scene& scene, Extras& extras, Joint& joint) {
  const std::string name = clean_text(extras.text("to", ""), kMaxBodyName);
  if (name.empty()) return;
  std::vector<std::string> names;
  for (const Body& body : scene.bodies) names.push_back(body.name);
  for (std::size_t b = 0; b < names.size(); ++b)
    if (names[b] == name) joint.other = static_cast<int>(b);
  if (joint.other < 0) {
    extras.fail("to", "names the body '" + name + "', and there is none",
                did_you_mean(name, names) + "Name one of the bodies, or leave it out for the world");
  } else if (joint.other == joint.body) {
    extras.fail("to", "names the body that it hangs on", "Name the other one, or leave it out for the world");
  }
}

/// Both bodies can be joined, and one of them moves by it.
void check_bodies(const Scene& scene, Extras& extras, const Joint& joint) {
  bool any_free = false;
  for (const int b : {joint.body, joint.other}) {
    if (b < 0) continue;
    const Body& body = scene.bodies[static_cast<std::size_t>(b)];
    any_free = any_free || body.motion == BodyMotion::kFree;
    if (body.point_probe)
      extras.fail(b == joint.body ? "slosh" : "to",
                  "joins '" + body.name + "', which is a point and cannot turn",
                  "Join bodies (slosh = \"body\")");
  }
  if (!any_free && joint.body >= 0)
    extras.fail("slosh", "is \"joint\", and neither of its two bodies is free",
                "Give one of them motion = \"free\"");
}

void refuse_field(Extras& extras, const char* key, const char* of, const Joint& joint) {
  if (!extras.has(key)) return;
  extras.known(key);
  extras.fail(key,
              std::string("is a ") + of + "'s, and the joint is a " +
                  kJointKindNames[static_cast<std::size_t>(joint.kind)],
              std::string("Give kind = \"") + of + "\", or leave it out");
}

/// Above what it lets go, and when it closes.
void read_joint_changes(Extras& extras, Joint& joint) {
  for (const char* key : {"breaks_n", "breaks_nm"}) extras.known(key);
  if (extras.has("breaks_n")) joint.breaks_force = extras.number("breaks_n", 0.0, kBreaks);
  if (extras.has("breaks_nm")) joint.breaks_torque = extras.number("breaks_nm", 0.0, kBreaks);
  if (joint.kind != JointKind::kFixed) return;
  for (const char* key : kFixedFields) extras.known(key);
  joint.starts_apart = extras.flag("starts_apart", false);
  if (extras.has("joins_m")) {
    joint.joins_within = extras.number("joins_m", 0.0, kJoinsWithin);
    joint.joins_turn = extras.number("joins_deg", kUsualJoinsTurn, kJoinsTurn) * glm::pi<double>() / 180.0;
    return;
  }
  const char* const mend = "Give joins_m: how near each other its two frames close it";
  if (joint.starts_apart)
    extras.fail("starts_apart", "is true, and joins_m is missing: it would never close", mend);
  if (!extras.has("joins_deg")) return;
  extras.fail("joins_deg", "asks for a joint that closes, and joins_m is missing", mend);
}

/// The frame on the other body, where another empty has it.
void read_meets(const Reading& reading, Extras& extras, Joint& joint) {
  const std::string name = extras.text("meets", "");
  if (name.empty() || joint.kind != JointKind::kFixed) return;
  if (!joint.starts_apart)
    return extras.fail("meets", "is of a joint that starts apart, and this one holds from the start on",
                       "Give starts_apart = true, or leave it out");
  int found = -1, count = 0;
  for (const int node : reading.document.nodes) {
    if (reading.document.name(node) != name) continue;
    found = node;
    ++count;
  }
  if (count != 1)
    return extras.fail(
        "meets", "names '" + name + (count == 0 ? "', and there is none" : "', and several are called so"),
        "Name an empty that is a child of the other body, where the two are to meet");
  const int up = body_node_above(reading, found);
  const int body = up < 0 ? -1 : reading.body_of_node.at(up);
  if (body != joint.other)
    return extras.fail("meets", "names '" + name + "', which is not on the other body",
                       joint.other < 0 ? "Take it off its body, or name that one in to"
                                       : "Parent it to the body that to names");
  Pose holds, world;
  glm::dmat3 rest;
  if (up >= 0 && read_pose(reading, up, holds, rest)) return;  // told with the body
  if (const Problem problem = read_pose(reading, found, world, rest))
    return extras.fail("meets", "names '" + name + "', which " + problem->what, problem->mend);
  joint.meets = compose(inverse(holds), world);
}

void read_joint_fields(Extras& extras, Joint& joint) {
  const char* const kind = kJointKindNames[static_cast<std::size_t>(joint.kind)];
  for (std::size_t of = 0; of < std::size(kJointFields); ++of) {
    if (kJointKindNames[of] == std::string_view(kind)) continue;
    const JointFields& others = kJointFields[of];
    for (const char* key : {others.least, others.most, others.damping, others.speed, others.limit})
      refuse_field(extras, key, kJointKindNames[of], joint);
  }
  read_joint_changes(extras, joint);
  if (joint.kind == JointKind::kFixed) return;
  for (const char* key : kFixedFields)
    refuse_field(extras, key, kJointKindNames[static_cast<std::size_t>(JointKind::kFixed)], joint);
  const bool hinge = joint.kind == JointKind::kHinge;
  const JointFields& fields = kJointFields[hinge ? 0 : 1];
  const double unit = hinge ? glm::pi<double>() / 180.0 : 1.0;
  const double widest = hinge ? kMaxStopTurn : kMaxStopWay;
  if (extras.has(fields.least)) joint.lower = unit * extras.number(fields.least, 0.0, Range{-widest, 0.0});
  if (extras.has(fields.most)) joint.upper = unit * extras.number(fields.most, 0.0, Range{0.0, widest});
  joint.damping = extras.number(fields.damping, 0.0, kJointForce);
  joint.motor_speed = extras.number(fields.speed, 0.0, kMotorSpeed);
  joint.motor_limit = extras.number(fields.limit, 0.0, kJointForce);
  if (extras.has(fields.speed) && !(joint.motor_limit > 0.0))
    extras.fail(fields.speed, std::string("asks for a motor, and ") + fields.limit + " is missing",
                std::string("Give ") + fields.limit + ": the most that the motor has");
}

}  // namespace

Problem read_joint(Reading& reading, int node) {
  Scene& scene = reading.scene;
  Joint joint;
  joint.name = reading.document.name(node);
  Extras extras(reading.document.extras[node], reading.document.owner(node));
  extras.text("slosh", "");
  const Problem place = place_joint(reading, node, joint);
  const std::string kind =
      extras.choice("kind", "hinge", {kJointKindNames[0], kJointKindNames[1], kJointKindNames[2]});
  for (std::size_t k = 0; k < kJointKindNames.size(); ++k)
    if (kind == kJointKindNames[k]) joint.kind = static_cast<JointKind>(k);
  if (!extras.has("kind")) extras.fail("kind", "is missing", "Give one of: hinge, slider, fixed");
  read_other(scene, extras, joint);
  check_bodies(scene, extras, joint);
  read_joint_fields(extras, joint);
  read_meets(reading, extras, joint);
  if (Problem problem = all_of(reading, place, extras)) return problem;
  if (scene.joints.size() >= kMaxJoints)
    return Error{reading.document.owner(node), "more than " + std::to_string(kMaxJoints) + " joints",
                 "Use fewer"};
  scene.joints.push_back(std::move(joint));
  return std::nullopt;
}

Problem read_keys(Reading& reading, int node, Body& body) {
  const std::string owner = reading.document.owner(node);
  if (!gltf::is_animated(reading.document, node))
    return Error{owner, "is driven, and its animation is missing",
                 "Animate its location or rotation, and export with animations; or give motion = \"fixed\""};
  Result<std::vector<PoseKey>> keys = gltf::read_motion(reading.document, node);
  if (!keys) return keys.error();
  body.keys = std::move(keys.value());
  body.pose = body.keys.front().pose;
  for (std::size_t k = 0; k < body.keys.size(); ++k) {
    const PoseKey& key = body.keys[k];
    if (glm::any(glm::greaterThan(glm::abs(key.pose.position), glm::dvec3(kFarthestPlace))))
      return Error{owner,
                   "is farther than " + gltf::short_number(kFarthestPlace) +
                       " m from the scene's origin at " + gltf::short_number(key.time) + " s",
                   "Mend the key; sizes are in metres"};
    if (k == 0) continue;
    const PoseKey& before = body.keys[k - 1];
    const double lasts = key.time - before.time;
    const double speed = glm::distance(before.pose.position, key.pose.position) / lasts;
    const double turning =
        glm::length(rotation_between(before.pose.orientation, key.pose.orientation)) / lasts;
    if (speed <= kDrivenSpeed && turning <= kDrivenAngularSpeed) continue;
    return Error{owner,
                 "is driven at " + gltf::short_number(speed) + " m/s and " + gltf::short_number(turning) +
                     " rad/s at " + gltf::short_number(key.time) + " s: at most " +
                     gltf::short_number(kDrivenSpeed) + " m/s and " +
                     gltf::short_number(kDrivenAngularSpeed) + " rad/s can be",
                 "Give its keys more time between them"};
  }
  const Pose &first = body.keys.front().pose, &last = body.keys.back().pose;
  if (body.repeats && (glm::distance(first.position, last.position) > kMeetsWay ||
                       glm::length(rotation_between(first.orientation, last.orientation)) > kMeetsTurn))
    return Error{owner + ": extras.repeat",
                 "is true, and the last key is not where the first is: it would jump",
                 "Give the last key the first one's location and rotation (a whole turn is the same)"};
  if (!body.repeats) note_late_keys(reading, node, body.keys);
  return std::nullopt;
}

}  // namespace slosh::reading
