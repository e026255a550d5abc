// The Novint Falcon as a hand: three axes of force.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "net/clock.h"
#include "peer/devices/camera_view.h"
#include "peer/devices/falcon_kinematics.h"
#include "peer/devices/falcon_protocol.h"
#include "peer/devices/hand_map.h"
#include "peer/devices/velocity_window.h"

namespace slosh {

/// On its own thread (DevicePort) at the pace of its USB: each reading is answered by one packet of motor
/// values. Until its three arms were moved through their zeros it says nothing and gets no force. A force
/// that no mechanism place carries (singular, not reachable) is none. Unplugged or without power it is
/// silent, and looked for every kLookAgain: it goes on where it is when it is back, has its firmware and was
/// moved through its zeros.
class FalconDevice final : public Device {
 public:
  using OpenLink = std::function<Result<std::unique_ptr<FalconLink>>()>;
  using Clock = std::function<std::int64_t()>;

  /// `open_link`: open_falcon, or a test's; `now_ns`: steady_now_ns, or a test's.
  FalconDevice(OpenLink open_link, HandPlace place, Clock now_ns = steady_now_ns);
  ~FalconDevice() override;

  /// Errors: the link's; the firmware is not named, cannot be read, comes back otherwise; its file has a
  /// mistake.
  Result<bool> open() override;
  DeviceReport read(const DeviceMoment& moment) override;
  void write(const Wrench& on_hand) override;
  DeviceLimits limits() const override { return limits_; }
  void look_from(const glm::dquat& axes) override { camera_now_.publish(axes); }
  void close() override;
  std::string kind() const override { return "falcon"; }
  std::string trouble() const override;
  std::vector<std::string> warnings() const override { return warnings_; }

  static constexpr double kLookAgain = 1.0;  ///< s

 private:
  /// Whether it answers packets already: firmware stays until its power goes.
  bool answers();
  Result<bool> start(const std::filesystem::path& firmware);
  /// Its packets run, with its firmware sent where it has none, and the first is on its way.
  Result<bool> bring_up();
  void lose(const std::string& words);
  void look_again(std::int64_t now_ns);
  std::optional<FalconState> next_state();
  bool send(const std::array<int, 3>& motors);
  void set_trouble(const std::string& words);
  DeviceReport silent() const;

  OpenLink open_link_;
  const HandPlace place_;
  Clock now_ns_;
  std::unique_ptr<FalconLink> link_;
  CameraView camera_now_;
  std::optional<HandMap> map_;
  DeviceLimits limits_;
  std::vector<std::string> warnings_;
  std::optional<std::string> firmware_;  // its file
  FalconStream stream_;
  VelocityWindow velocity_;
  FalconAngles angles_{};
  glm::dvec3 grip_{0.0, 0.0, kFalconMiddle};
  bool homed_ = false;
  bool placed_ = false;    // the last reading has a place
  bool runs_ = false;      // it has its firmware
  bool answered_ = false;  // what was sent last
  std::array<int, 3> sent_{};
  std::int64_t sent_ns_ = 0;
  std::int64_t received_ns_ = 0;
  std::int64_t looked_ns_ = 0;

  mutable std::mutex mutex_;
  std::string trouble_;
};

}  // namespace slosh
