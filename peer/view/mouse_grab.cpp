#define GLM_ENABLE_EXPERIMENTAL  // glm/gtx
#include "peer/view/mouse_grab.h"

#include <algorithm>
#include <cmath>
#include <glm/gtx/intersect.hpp>
#include <glm/gtx/quaternion.hpp>
#include <limits>

namespace slosh {
namespace {

constexpr double kGrabReach = 22.0;       // px about a handle's middle that count as on it
constexpr double kTiltPerNotch = 0.07;    // rad: 4°
constexpr double kTiltPerPixel = 0.008;   // rad
constexpr double kDepthPerNotch = 0.015;  // of the eye's distance
// The least share of its length that an upright metre, or one away from the eye, may show in the picture:
// seen from nearly above, a drag upward would throw the hand away.
constexpr double kMinShown = 0.35;

glm::dvec3 level(const glm::dvec3& v, const glm::dvec3& otherwise) {
  const glm::dvec3 flat(v.x, 0.0, v.z);
  const double length = glm::length(flat);
  return length > 1e-6 ? flat / length : otherwise;
}

}  // namespace

MouseGrab::MouseGrab(const Scene& scene) : scene_(scene), hands_(scene.grips.size()) {}

bool MouseGrab::any_taken() const {
  return std::any_of(hands_.begin(), hands_.end(), [](const Hand& hand) { return hand.taken; });
}

bool MouseGrab::has_lent(int body, const std::vector<SharedHandle*>& lent) const {
  for (std::size_t i = 0; i < lent.size() && i < scene_.grips.size(); ++i)
    if (lent[i] != nullptr && scene_.grips[i].body == body) return true;
  return false;
}

/// How far along the ray the body's mesh is met, in m.
std::optional<double> MouseGrab::hit(int body, const Pose& pose, const glm::dvec3& eye,
                                     const glm::dvec3& ray) const {
  const int index = scene_.bodies[static_cast<std::size_t>(body)].mesh;
  if (index < 0) return std::nullopt;
  const TriangleMesh& mesh = scene_.meshes[static_cast<std::size_t>(index)];
  const Pose to_mesh = inverse(pose);
  const glm::dvec3 from = transform_point(to_mesh, eye);
  const glm::dvec3 way = to_mesh.orientation * ray;
  double nearest = std::numeric_limits<double>::infinity();
  for (const glm::uvec3& t : mesh.triangles) {
    glm::dvec2 where(0.0);
    double along = 0.0;
    if (glm::intersectRayTriangle(from, way, glm::dvec3(mesh.positions[t.x]), glm::dvec3(mesh.positions[t.y]),
                                  glm::dvec3(mesh.positions[t.z]), where, along) &&
        along > 0.0) {
      nearest = std::min(nearest, along);
    }
  }
  if (!std::isfinite(nearest)) return std::nullopt;
  return nearest;
}

std::optional<Grabbed> MouseGrab::look(const glm::dvec2& pixel, const OrbitCamera& camera,
                                       const glm::ivec2& picture, const BodySnapshot& world,
                                       const std::vector<SharedHandle*>& lent) const {
  std::optional<Grabbed> found;
  double nearest = kGrabReach;
  for (std::size_t i = 0; i < lent.size() && i < world.grips.size(); ++i) {
    if (lent[i] == nullptr) continue;
    const glm::dvec3 place = world.grips[i].handle.position;
    if (camera.depth_of(place) <= 0.0) continue;
    const double away = glm::distance(camera.pixel_of(place, picture), pixel);
    if (away > nearest) continue;
    nearest = away;
    found = Grabbed{scene_.grips[i].body, static_cast<int>(i), place};
  }
  if (found) return found;
  const glm::dvec3 ray = camera.ray(pixel, picture);
  double depth = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < scene_.bodies.size() && b < world.bodies.size(); ++b) {
    const int body = static_cast<int>(b);
    if (!has_lent(body, lent) || world.bodies[b].away()) continue;
    const std::optional<double> along = hit(body, world.bodies[b].pose, camera.eye(), ray);
    if (!along || *along >= depth) continue;
    depth = *along;
    found = Grabbed{body, -1, camera.eye() + *along * ray};
  }
  return found;
}

void MouseGrab::take(const std::vector<SharedHandle*>& lent) {
  glm::dvec3 others(0.0);
  int count = 0;
  for (std::size_t i = 0; i < lent.size() && i < hands_.size(); ++i) {
    Hand& hand = hands_[i];
    if (lent[i] == nullptr || scene_.grips[i].body != held_->body) continue;
    (void)lent[i]->now.update();
    hand.of = lent[i];
    hand.taken = true;
    hand.wanted = lent[i]->now.front();
    if (static_cast<int>(i) == held_->grip) continue;
    others += hand.wanted.position;
    count += 1;
  }
  pivots_ = held_->grip >= 0 && count > 0;
  rig_ = Pose{};
  if (held_->grip >= 0) handle_ = hands_[static_cast<std::size_t>(held_->grip)].wanted.position;
  rig_.position = count > 0 ? others / static_cast<double>(count) : handle_;
  const Pose to_rig = inverse(rig_);
  for (Hand& hand : hands_)
    if (hand.taken) hand.in_rig = compose(to_rig, hand.wanted);
}

/// Moves what is held; where it pivots, the handle goes there and the rest turns, and follows when it is
/// pulled.
void MouseGrab::shift(const glm::dvec3& by) {
  if (!pivots_) {
    rig_.position += by;
    return;
  }
  const glm::dvec3 arm = handle_ - rig_.position;
  const double length = glm::length(arm);
  const glm::dvec3 reach = arm + by;
  if (length < 1e-6 || glm::length(reach) < 0.2 * length)
    return;  // the handle would be pushed through the pivot
  const glm::dvec3 way = glm::normalize(reach);
  const glm::dquat turn = glm::rotation(arm / length, way);
  rig_.orientation = glm::normalize(turn * rig_.orientation);
  rig_.position += (glm::length(reach) - length) * way;
  handle_ = rig_.position + length * way;
}

void MouseGrab::move(const InputState& input, const OrbitCamera& camera, const glm::ivec2& picture) {
  const glm::dvec2 moved(input.mouse_delta);
  const double notches = input.scroll.y;
  const glm::dvec3 away = level(camera.forward(), camera.up());
  const double metres = camera.metres_per_pixel(std::max(camera.depth_of(held_->place), 0.05), picture.y);
  const double shown_up = std::max(glm::dot(camera.up(), glm::dvec3(0.0, 1.0, 0.0)), kMinShown);
  const double shown_away = std::max(std::abs(glm::dot(camera.up(), away)), kMinShown);
  glm::dvec3 by(0.0);
  glm::dvec3 tilt(0.0);
  if (input.held(Key::kControl)) {
    tilt = kTiltPerPixel * (moved.x * away + moved.y * camera.right());
  } else if (input.held(Key::kShift)) {
    by = metres * (moved.x * camera.right() - moved.y / shown_away * away);
  } else {
    by = metres * (moved.x * camera.right() - moved.y / shown_up * glm::dvec3(0.0, 1.0, 0.0));
  }
  if (input.held(Key::kShift)) {
    by += kDepthPerNotch * camera.distance() * notches * away;
  } else {
    tilt -= kTiltPerNotch * notches * away;
  }
  // Nothing is carried out of the world's domain: what is wanted stays where fluid can be.
  const glm::dvec3 inside =
      glm::clamp(held_->place + by, scene_.domain_min, scene_.domain_max) - held_->place;
  held_->place += inside;
  shift(inside);
  if (tilt != glm::dvec3(0.0)) {
    tilted_ = true;
    const glm::dvec3 arm = handle_ - rig_.position;
    rig_.orientation = rotate_by(rig_.orientation, tilt);
    handle_ = rig_.position + rotate_by(glm::dquat(1.0, 0.0, 0.0, 0.0), tilt) * arm;
  }
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    if (hands_[i].taken && scene_.grips[i].body == held_->body)
      hands_[i].wanted = compose(rig_, hands_[i].in_rig);
  }
}

void MouseGrab::tell() const {
  for (const Hand& hand : hands_) {
    if (hand.of == nullptr) continue;
    hand.of->wish.back() = {hand.taken, hand.wanted};
    hand.of->wish.publish();
  }
}

bool MouseGrab::follow(const InputState& input, const OrbitCamera& camera, const glm::ivec2& picture,
                       const BodySnapshot& world, const std::vector<SharedHandle*>& lent) {
  // Hands come and go over a network: one that is another now is not taken any more.
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    SharedHandle* const now = i < lent.size() ? lent[i] : nullptr;
    if (hands_[i].of != nullptr && hands_[i].of != now) {
      hands_[i] = Hand{};
      if (held_ && scene_.grips[i].body == held_->body) held_.reset();
    }
  }
  const bool down = input.held(MouseButton::kLeft);
  const bool pressed = down && !was_down_;
  was_down_ = down;
  if (!down) held_.reset();
  if (held_) {
    move(input, camera, picture);
    tell();
    return true;
  }
  over_.reset();
  if (input.hud_wants_mouse || (down && !pressed)) return false;
  over_ = look(glm::dvec2(input.mouse), camera, picture, world, lent);
  if (!over_ || !pressed) return false;
  held_ = over_;
  take(lent);
  tell();
  return true;
}

void MouseGrab::give_back(const std::vector<SharedHandle*>& lent) {
  held_.reset();
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    if (i < lent.size() && hands_[i].of == lent[i] && hands_[i].of != nullptr) {
      hands_[i].of->wish.back() = {false, hands_[i].wanted};
      hands_[i].of->wish.publish();
    }
    hands_[i] = Hand{};
  }
}

}  // namespace slosh
