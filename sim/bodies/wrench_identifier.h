// From what the fluid did to a body lately to what it will do next: the line of a FluidWrenchModel.
#pragma once

#include <array>
#include <cstddef>

#include "sim/math/fluid_wrench.h"

namespace slosh {

/// What one step tells of one body.
struct FluidReading {
  double time = 0.0;              ///< simulated s, at the step's end
  Pose center;                    ///< of the centre of mass
  Twist twist;                    ///< that the step ended with
  Wrench wrench;                  ///< by the fluid, in the step, about the centre of mass
  const Matrix6* drag = nullptr;  ///< World::drags(); null where nothing is viscous
  int sub_steps = 1;              ///< of the step, in the last of which the wrench acted
};

/// What is known of a body beforehand.
struct WrenchBounds {
  double body_mass = 1.0;         ///< kg, > 0
  double gyration_squared = 0.0;  ///< m², of the body about its centre of mass
  double fluid_mass = 0.0;        ///< kg, all of the world's
  double reach = 0.01;            ///< m, how far the fluid about a body is taken to be alike; > 0
  glm::dvec3 up{0.0, 1.0, 0.0};   ///< against gravity; 0 = there is none
};

/// Recursive least squares with forgetting of the changes of the wrench over some milliseconds, on three
/// changes of the body, each through a matrix that is known:
///
///   δW = −c D δv − m D δa − k H δx
///
/// D is the drag that the particles of the body and of the fluid give each other while the fluid is held
/// (World::drags: positive semidefinite, with every lever arm, nothing for a body that has left the fluid),
/// or where nothing is viscous the body's own gyration; H is a vertical spring at the middle of what is
/// wetted. c, m and k are not negative, so that neither damping nor added mass nor stiffness can be. With
/// little motion to learn from they go back to 0.4, 0 and 0. What is left of the change over the last
/// milliseconds is the fluid's own; so much of it is carried on as such rests were lately seen to go on. One
/// thread.
class WrenchIdentifier {
 public:
  void restart(const WrenchBounds& bounds);
  /// Readings in the order of time, of steps of one length.
  void add(const FluidReading& reading);
  /// The line through the newest reading; body and tick are the caller's. After add().
  void fill(FluidWrenchModel& model) const;

  /// What was found: a share of D, s of it, N/m.
  double damping() const { return found_[0]; }
  double added_mass() const { return found_[1]; }
  double stiffness() const { return found_[2]; }

 private:
  static constexpr std::size_t kKept = 32;
  static constexpr std::size_t kUnknowns = 3;

  struct Entry {
    double time = 0.0;
    Pose center;
    Vector6 twist{};
    Vector6 mean_acceleration{};  // over the step
    Vector6 acceleration{};       // in the last sub-step, as it seems
    Vector6 wrench{};
    Vector6 rest{};     // of its change over the span, a second
    double drag = 0.0;  // N·s/m, the mean of D's linear diagonal
    bool rested = false;
  };
  const Entry& back(std::size_t steps) const { return entries_[(count_ - 1 - steps) % kKept]; }
  std::size_t lag(double time_step) const;
  void shape(const FluidReading& reading);
  void learn(const Entry& before, Entry& now, double time_step);
  void solve();
  void learn_rest(const Entry& before, const Entry& now, double keep);
  void note_alike(const Entry& before, const Entry& now, double keep);

  WrenchBounds bounds_;
  std::array<Entry, kKept> entries_{};
  std::size_t count_ = 0;
  std::size_t lag_ = 1;
  Matrix6 d_{};                // D of the newest reading
  Vector6 h_{};                // H = h hᵀ
  double usual_drag_ = 0.0;    // N·s/m, lately
  double arm_squared_ = 1e-4;  // m², torques against forces
  bool wet_ = false;
  std::array<std::array<double, kUnknowns>, kUnknowns> seen_{};  // Σ φᵀφ
  std::array<double, kUnknowns> answer_{};                       // Σ φᵀδW
  std::array<double, kUnknowns> found_{};
  std::array<double, 2> rest_product_{}, rest_square_{}, share_{};  // force, torque
  double rests_ = 0.0;                                              // how many count
  double change_square_ = 0.0, way_square_ = 0.0;  // of the drag's share, and of the way meanwhile
};

}  // namespace slosh
