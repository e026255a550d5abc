#include "peer/view/orbit_camera.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace slosh {
namespace {

constexpr double kTurnPerPixel = 0.006;  // rad

}  // namespace

OrbitCamera::OrbitCamera(const Camera& camera) : start_(camera) {
  reset();
}

void OrbitCamera::reset() {
  target_ = start_.target;
  const glm::dvec3 offset = start_.eye - start_.target;
  distance_ = std::max(glm::length(offset), 1e-3);
  azimuth_ = std::atan2(offset.x, offset.z);
  elevation_ = std::clamp(std::asin(std::clamp(offset.y / distance_, -1.0, 1.0)), -kSteepest, kSteepest);
}

void OrbitCamera::turn(double about_y, double up) {
  azimuth_ += about_y;
  elevation_ = std::clamp(elevation_ + up, -kSteepest, kSteepest);
}

void OrbitCamera::zoom(double factor) {
  distance_ = std::clamp(distance_ * factor, 0.02, 50.0);
}

void OrbitCamera::pan(const glm::dvec2& heights) {
  target_ += height_at_target() * (heights.x * right() + heights.y * up());
}

void OrbitCamera::follow(const InputState& input, int picture_height) {
  if (input.hud_wants_mouse) return;
  if (input.held(MouseButton::kLeft)) {
    turn(-kTurnPerPixel * input.mouse_delta.x, kTurnPerPixel * input.mouse_delta.y);
  }
  if (input.held(MouseButton::kRight) || input.held(MouseButton::kMiddle)) {
    const double per_pixel = 1.0 / std::max(picture_height, 1);
    pan({-per_pixel * input.mouse_delta.x, per_pixel * input.mouse_delta.y});
  }
  if (input.scroll.y != 0.0f) zoom(std::pow(0.9, static_cast<double>(input.scroll.y)));
}

glm::dvec3 OrbitCamera::forward() const {
  return {-std::cos(elevation_) * std::sin(azimuth_), -std::sin(elevation_),
          -std::cos(elevation_) * std::cos(azimuth_)};
}
glm::dvec3 OrbitCamera::right() const {
  return glm::normalize(glm::cross(forward(), glm::dvec3(0, 1, 0)));
}
glm::dvec3 OrbitCamera::up() const {
  return glm::cross(right(), forward());
}
glm::dvec3 OrbitCamera::eye() const {
  return target_ - distance_ * forward();
}

double OrbitCamera::height_at_target() const {
  return 2.0 * distance_ * std::tan(0.5 * glm::radians(start_.vertical_fov_deg));
}

glm::dvec3 OrbitCamera::ray(const glm::dvec2& pixel, const glm::ivec2& size) const {
  const double metres = metres_per_pixel(1.0, size.y);
  const glm::dvec2 off = pixel - 0.5 * glm::dvec2(size);
  return glm::normalize(forward() + metres * (off.x * right() - off.y * up()));
}

glm::dvec2 OrbitCamera::pixel_of(const glm::dvec3& point, const glm::ivec2& size) const {
  const double metres = metres_per_pixel(depth_of(point), size.y);
  const glm::dvec3 off = point - eye();
  return 0.5 * glm::dvec2(size) + glm::dvec2(glm::dot(off, right()), -glm::dot(off, up())) / metres;
}

View OrbitCamera::view(double aspect) const {
  View view;
  view.near_plane = static_cast<float>(std::clamp(0.03 * distance_, 0.005, 0.1));
  view.far_plane = static_cast<float>(20.0 + 4.0 * distance_);
  view.view = glm::mat4(glm::lookAt(eye(), target_, glm::dvec3(0, 1, 0)));
  view.projection = glm::perspective(static_cast<float>(glm::radians(start_.vertical_fov_deg)),
                                     static_cast<float>(aspect), view.near_plane, view.far_plane);
  return view;
}

}  // namespace slosh
