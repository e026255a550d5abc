// What the handles ask of the bodies in one step.
#pragma once

#include <span>
#include <vector>

#include "sim/bodies/body_solve.h"
#include "sim/world.h"

namespace slosh {

/// True unless the input is a broken device's: not finite, out of all bounds.
bool usable(const HandleInput& input);

/// Checks the inputs and turns them into couplings.
class Hands {
 public:
  explicit Hands(const Scene& scene);

  /// The inputs of a step, one a grip; missing ones count as not engaged. In place of an unusable one the
  /// grip's last input stays where it is, and kStatusInputRejected is returned.
  /// `time_step` in s, by which stiffnesses go on to what is wanted.
  std::uint32_t take(std::span<const HandleInput> handles, double time_step);

  /// The couplings `elapsed` s into the step, the handles moved on with their twists, sorted by body.
  /// None where the body is gone.
  const std::vector<ActiveCoupling>& couple(const std::vector<RigidBody>& bodies, double elapsed);

  /// Times the scene's springs, > 0: what is asked for, and what acts on the way there. One a grip each.
  struct Stiffness {
    std::vector<double> wanted, acting;
  };
  const Stiffness& stiffness() const { return stiffness_; }
  void want_stiffness(std::size_t grip, double scale) { stiffness_.wanted[grip] = scale; }
  void restore(Stiffness stiffness) { stiffness_ = std::move(stiffness); }

  /// The inputs that count, one a grip.
  const std::vector<HandleInput>& last() const { return last_; }
  void restore(std::vector<HandleInput> last) { last_ = std::move(last); }

 private:
  std::vector<Grip> grips_;
  std::vector<HandleInput> last_;
  Stiffness stiffness_;
  std::vector<ActiveCoupling> couplings_;
};

}  // namespace slosh
