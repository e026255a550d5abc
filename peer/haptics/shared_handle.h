// A scripted hand that a person may take over with the mouse, and give back.
#pragma once

#include <memory>

#include "net/triple_buffer.h"
#include "peer/haptics/device.h"

namespace slosh {

/// What a window and a device loop exchange about one hand that both may move.
struct SharedHandle {
  struct Wish {
    bool taken = false;  ///< false: the script has it
    Pose pose;           ///< where the person wants the handle, world; while taken
  };
  explicit SharedHandle(const Pose& start) : now(start) {}

  TripleBuffer<Wish> wish;  ///< the window writes, the device loop reads
  TripleBuffer<Pose> now;   ///< the other way: where the handle is
};

/// Plays its script until somebody takes it. Taken, it follows where it is wanted as a critically damped
/// second-order system in the world's own time, so that it is as fast for the fluid in slow motion as at full
/// pace and stands in a world that stands; it is no faster than a careful hand. Given back, it goes home to
/// the script's motion, in no less than a second. As long as nobody takes it, its motion is bitwise the
/// script's.
class SharedHandleDevice final : public Device {
 public:
  /// `script` must be immediate().
  SharedHandleDevice(std::unique_ptr<Device> script, std::shared_ptr<SharedHandle> lent);

  DeviceReport read(const DeviceMoment& moment) noexcept override;
  DeviceLimits limits() const override { return script_->limits(); }
  bool immediate() const override { return true; }
  bool gives_way() const override { return false; }
  bool goes_with_world() const override { return true; }
  std::string kind() const override { return script_->kind(); }

 private:
  void follow(double elapsed) noexcept;
  void begin_return(const Pose& script) noexcept;
  DeviceReport on_the_way_home(DeviceReport script, double elapsed) noexcept;

  std::unique_ptr<Device> script_;
  std::shared_ptr<SharedHandle> lent_;
  SharedHandle::Wish wish_;
  Pose pose_;  // where the handle is, while it is not the script's
  Twist twist_;
  double time_ = -1.0;    // simulated s of the last reading
  glm::dvec3 away_{0.0};  // m and rad from the script's pose when it was given back
  glm::dvec3 turned_{0.0};
  double way_home_ = 0.0;  // s that the return takes
  double left_ = 0.0;      // s of it that are left; 0: at home
};

}  // namespace slosh
