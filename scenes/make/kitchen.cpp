#include "scenes/make/kitchen.h"

#include <cmath>

namespace slosh::make {
namespace {

constexpr double kBarRadius = 0.008;

std::vector<glm::dvec2> arc(double height, double radius, double from_deg, double to_deg, int steps) {
  std::vector<glm::dvec2> line;
  for (int i = 0; i <= steps; ++i) {
    const double angle = glm::radians(from_deg + (to_deg - from_deg) * i / steps);
    const double r = radius * std::cos(angle);
    line.emplace_back(r < 1e-9 ? 0.0 : r, height + radius * std::sin(angle));
  }
  return line;
}

}  // namespace

Solid bar(double from, double to, double height) {
  return tube({{from, height, 0.0}, {0.5 * (from + to), height, 0.0}, {to, height, 0.0}}, kBarRadius, 24);
}

Solid Bowl::solid() const {
  std::vector<glm::dvec2> profile = arc(rim(), radius + kWall, -90.0, 0.0, 20);
  const std::vector<glm::dvec2> inside = arc(rim(), radius, 0.0, -90.0, 20);
  profile.insert(profile.end(), inside.begin(), inside.end());
  return merged(lathe(round_corners(profile, 0.003, 3), 64), bar(bar_from, bar_to, bar_height()));
}

Solid Bowl::filling(double below) const {
  const double top = -glm::degrees(std::asin(below / radius));
  std::vector<glm::dvec2> profile = arc(rim(), radius, -90.0, top, 20);
  profile.emplace_back(0.0, profile.back().y);
  return lathe(profile, 64);
}

void add_held(SceneWriter& writer, const std::string& name, int node, const Pose& grip, int device,
              const std::function<Pose(double)>& body_pose, double duration) {
  writer.add_node(name, -1, grip,
                  {{"slosh", "grip"},
                   {"stiffness_n_m", 2000.0},
                   {"damping_n_s_m", 60.0},
                   {"rotational_stiffness_nm_rad", 60.0},
                   {"rotational_damping_nm_s_rad", 1.5},
                   {"device", device}},
                  node);
  writer.add_hand(name + "_motion", name, [=](double t) { return compose(body_pose(t), grip); }, duration);
}

}  // namespace slosh::make
