// A camera that turns about what it looks at.
#pragma once

#include "render/frame.h"
#include "render/input.h"
#include "scenes/scene.h"

namespace slosh {

class OrbitCamera {
 public:
  explicit OrbitCamera(const Camera& camera);

  static constexpr double kSteepest =
      1.55;  ///< rad above or below the horizon: the up direction stays defined

  /// Angles in rad; the height is kept short of straight up and down.
  void turn(double about_y, double up);
  /// Factor on the distance, > 0.
  void zoom(double factor);
  /// Shifts the target in the picture's plane, in picture heights.
  void pan(const glm::dvec2& heights);
  /// Left drag turns, right or middle drag pans, the wheel zooms.
  void follow(const InputState& input, int picture_height);
  void reset();

  /// Where it is, to come back to.
  struct Look {
    glm::dvec3 target{0.0};
    double distance = 1.0, azimuth = 0.0, elevation = 0.0;
  };
  Look look() const { return {target_, distance_, azimuth_, elevation_}; }
  void look(const Look& at) {
    target_ = at.target;
    distance_ = at.distance;
    azimuth_ = at.azimuth;
    elevation_ = at.elevation;
  }

  View view(double aspect) const;
  glm::dvec3 eye() const;
  glm::dvec3 target() const { return target_; }
  double distance() const { return distance_; }  ///< m, eye to target
  glm::dvec3 right() const;
  glm::dvec3 up() const;
  glm::dvec3 forward() const;
  /// World metres that a picture's height spans at the target.
  double height_at_target() const;
  /// World metres that a pixel of a picture so high spans at `depth` m before the eye.
  double metres_per_pixel(double depth, int picture_height) const {
    return height_at_target() / distance_ * depth / (picture_height > 0 ? picture_height : 1);
  }
  /// m that `point` lies before the eye, along forward(); below 0: behind it.
  double depth_of(const glm::dvec3& point) const { return glm::dot(point - eye(), forward()); }
  /// From the eye through a pixel (from the top left corner of a picture of `size` pixels), of unit length.
  glm::dvec3 ray(const glm::dvec2& pixel, const glm::ivec2& size) const;
  /// The pixel at which `point`, which must lie before the eye, is seen.
  glm::dvec2 pixel_of(const glm::dvec3& point, const glm::ivec2& size) const;

 private:
  Camera start_;
  glm::dvec3 target_{0.0};
  double distance_ = 1.0;
  double azimuth_ = 0.0;    // rad about y, from +z
  double elevation_ = 0.0;  // rad above the horizon
};

}  // namespace slosh
