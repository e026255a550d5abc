// Whether what hands feel has come to rest.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "sim/snapshot.h"

namespace slosh {

/// Compares the mean force on every hand over one window with the one before: a bounce of a held body, 6 to
/// 11 Hz, passes several times within one.
class Steadiness {
 public:
  static constexpr double kWindow = 0.2;   ///< s
  static constexpr double kShare = 0.005;  ///< of the force: what may lie between two windows, and within one
  static constexpr double kMin = 0.005;    ///< N: a device's own noise

  /// What hands felt over another `seconds` (> 0).
  void feel(const std::vector<GripState>& grips, double seconds);

  /// False until two windows have passed.
  bool steady() const { return steady_; }

 private:
  struct Window {
    glm::dvec3 sum{0.0};
    glm::dvec3 low{INFINITY};
    glm::dvec3 high{-INFINITY};
  };
  std::vector<Window> now_;
  std::vector<glm::dvec3> before_;
  double felt_ = 0.0;  // s of the window
  int samples_ = 0;
  bool steady_ = false;
};

}  // namespace slosh
