// Grips, the hands that hold them, and the camera.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "scenes/gltf/animation.h"
#include "scenes/reading/reading.h"
#include "sim/math/limits.h"

namespace slosh::reading {
namespace {

using gltf::Extras;
using gltf::Range;

/// How far a hand may be from its grip at the start, m.
constexpr double kFarthestHand = 0.05;

std::string grip_names(const Scene& scene) {
  std::string list;
  for (const Grip& grip : scene.grips) list += (list.empty() ? "" : ", ") + grip.name;
  return list.empty() ? "none" : list;
}

}  // namespace

// One that has one key stands still on purpose.
void note_late_keys(Reading& reading, int node, const std::vector<PoseKey>& keys) {
  constexpr double kWorthTelling = 0.5;  // s
  const double duration = reading.scene.duration;
  const auto same = [](const PoseKey& a, const PoseKey& b) {
    return a.pose.position == b.pose.position && a.pose.orientation == b.pose.orientation;
  };
  // Reading begins every motion at 0: until its own first key a hand stands still.
  const auto moves = std::adjacent_find(keys.begin(), keys.end(),
                                        [&](const PoseKey& a, const PoseKey& b) { return !same(a, b); });
  if (keys.size() < 2 || moves == keys.end() || keys.back().time <= duration + kWorthTelling) return;
  const std::string lasts = "its keys go on to " + gltf::short_number(keys.back().time) + " s";
  reading.notes.push_back(
      {"late-keys",
       {reading.document.owner(node),
        moves->time >= duration
            ? "it begins to move at " + gltf::short_number(moves->time) + " s, and the run lasts " +
                  gltf::short_number(duration) + " s: it stands still"
            : lasts + ", and the run lasts " + gltf::short_number(duration) + " s",
        "Give the scene duration_s = " + gltf::short_number(std::ceil(keys.back().time)) +
            ", or move the keys: in Blender they count from frame 0"}});
}

/// The body that a grip hangs on, and where on it.
Problem place_grip(Reading& reading, int node, Grip& grip) {
  const gltf::Document& document = reading.document;
  int up = document.parent[node];
  while (up >= 0 && !reading.body_of_node.contains(up)) up = document.parent[up];
  if (up < 0) {
    return Error{document.owner(node), "is not the child of a body",
                 "Parent it to the body that it holds (slosh = \"body\" or \"probe\")"};
  }
  grip.body = reading.body_of_node[up];
  const Body& body = reading.scene.bodies[grip.body];
  if (body.motion != BodyMotion::kFree) {
    return Error{document.owner(node),
                 "holds the body '" + body.name + "', which is " +
                     (body.motion == BodyMotion::kDriven ? "driven by its keys" : "fixed"),
                 "Give the body motion = \"free\", or take the grip out"};
  }
  Pose world;
  glm::dmat3 rest;
  if (Problem problem = read_pose(reading, node, world, rest)) return problem;
  grip.pose = compose(inverse(body.pose), world);
  return std::nullopt;
}

Problem read_grip(Reading& reading, int node) {
  const gltf::Document& document = reading.document;
  Grip grip;
  grip.name = document.name(node);
  Extras extras(document.extras[node], document.owner(node));
  extras.text("slosh", "");
  const Problem place = place_grip(reading, node, grip);
  const bool on_point = grip.body >= 0 && reading.scene.bodies[grip.body].point_probe;
  grip.stiffness = extras.number("stiffness_n_m", grip.stiffness, Range{0.0, 1e6});
  grip.damping = extras.number("damping_n_s_m", grip.damping, Range{0.0, 1e4});
  const double turning = on_point ? 0.0 : 1.0;
  grip.rotational_stiffness =
      extras.number("rotational_stiffness_nm_rad", turning * grip.rotational_stiffness, Range{0.0, 1e4});
  grip.rotational_damping =
      extras.number("rotational_damping_nm_s_rad", turning * grip.rotational_damping, Range{0.0, 1e3});
  if (on_point && (grip.rotational_stiffness > 0.0 || grip.rotational_damping > 0.0)) {
    extras.fail("rotational_stiffness_nm_rad",
                "is not 0, but '" + reading.scene.bodies[grip.body].name + "' is a point and cannot turn",
                "Leave it out, and rotational_damping_nm_s_rad too");
  }
  const int device = extras.integer("device", -1, -1, 1000);
  if (Problem problem = all_of(reading, place, extras)) return problem;
  reading.devices.push_back(device);
  reading.grip_nodes.push_back(node);
  reading.scene.grips.push_back(std::move(grip));
  return std::nullopt;
}

Problem order_grips(Reading& reading) {
  std::vector<std::size_t> order(reading.scene.grips.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto rank = [&](std::size_t i) { return reading.devices[i] < 0 ? 1 << 20 : reading.devices[i]; };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  std::vector<Grip> grips;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const int device = reading.devices[order[i]];
    if (i > 0 && device >= 0 && device == reading.devices[order[i - 1]]) {
      return Error{reading.document.owner(reading.grip_nodes[order[i]]) + ": extras.device",
                   "is " + std::to_string(device) + ", as on grip '" + grips.back().name + "'",
                   "Number the grips' devices from 0, each once"};
    }
    grips.push_back(std::move(reading.scene.grips[order[i]]));
  }
  reading.scene.grips = std::move(grips);
  return std::nullopt;
}

Problem read_hand(Reading& reading, int node) {
  const gltf::Document& document = reading.document;
  Extras extras(document.extras[node], document.owner(node));
  extras.text("slosh", "");
  const std::string name = extras.text("grip", "");
  auto& grips = reading.scene.grips;
  const auto grip = std::find_if(grips.begin(), grips.end(), [&](const Grip& g) { return g.name == name; });
  if (grip == grips.end()) {
    extras.fail("grip", extras.has("grip") ? "names '" + name + "', which is no grip" : "is missing",
                "Name one of the grips: " + grip_names(reading.scene));
  }
  if (Problem problem = all_of(reading, std::nullopt, extras)) return problem;
  if (!grip->hand_motion.empty()) {
    extras.fail("grip", "names '" + name + "', which another hand holds already", "Keep one hand a grip");
    return extras.error();
  }
  Result<std::vector<PoseKey>> motion = gltf::read_motion(document, node);
  if (!motion) return motion.error();
  const glm::dvec3 at = compose(reading.scene.bodies[grip->body].pose, grip->pose).position;
  const double apart = glm::length(motion.value().front().pose.position - at);
  if (apart > kFarthestHand) {
    return Error{document.owner(node),
                 "starts " + gltf::short_number(1000.0 * apart) + " mm from its grip '" + name + "'",
                 "Put the hand where the grip is at time 0 (at most 50 mm off)"};
  }
  for (const PoseKey& key : motion.value()) {
    if (glm::length(key.pose.position) <= kFarthestHandle) continue;
    return Error{document.owner(node),
                 "is " + gltf::short_number(glm::length(key.pose.position)) +
                     " m from the scene's origin at " + gltf::short_number(key.time) +
                     " s: no hand is farther than " + gltf::short_number(kFarthestHandle) + " m",
                 "Mend the key; sizes are in metres"};
  }
  grip->hand_motion = std::move(motion.value());
  note_late_keys(reading, node, grip->hand_motion);
  return std::nullopt;
}

Problem read_camera(Reading& reading) {
  const gltf::Document& document = reading.document;
  const Bounds bounds = bounds_of_scene(reading.scene);
  const glm::dvec3 center = 0.5 * (bounds.low + bounds.high);
  const double radius = std::max(0.5 * glm::length(bounds.high - bounds.low), 0.05);
  Camera& camera = reading.scene.camera;
  const auto leave_out = [&](Error problem) {
    problem.what += "; the view is chosen for you";
    reading.notes.push_back({"camera", std::move(problem)});
  };
  for (const int node : document.nodes) {
    const int index = document.model.nodes[node].camera;
    if (index < 0) continue;
    const tinygltf::Camera& source = document.model.cameras[index];
    if (source.type != "perspective") {
      leave_out({document.owner(node), "the camera is orthographic", "Use a perspective camera"});
      continue;
    }
    const double fov = glm::degrees(source.perspective.yfov);
    if (!(fov >= 1.0 && fov <= 150.0)) {
      leave_out({document.owner(node) + ": yfov", "is " + gltf::short_number(fov) + " degrees",
                 "Give 1 to 150 degrees"});
      continue;
    }
    Pose pose;
    glm::dmat3 rest;
    if (const Problem problem = read_pose(reading, node, pose, rest)) {
      leave_out(*problem);
      continue;
    }
    const glm::dvec3 forward = pose.orientation * glm::dvec3(0.0, 0.0, -1.0);
    camera.vertical_fov_deg = fov;
    camera.eye = pose.position;
    camera.target = pose.position + forward * std::max(glm::length(center - pose.position), 0.1);
    return std::nullopt;
  }
  camera.target = center;
  camera.eye = center + glm::normalize(glm::dvec3(0.5, 0.6, 1.0)) * (radius / glm::sin(glm::radians(20.0)));
  return std::nullopt;
}

}  // namespace slosh::reading
