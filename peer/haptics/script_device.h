// Devices that play a known motion: the scene's own (`script`) or a recorded one (`replay:FILE`).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "peer/haptics/device.h"
#include "peer/haptics/pose_track.h"

namespace slosh {

/// Moves along a track at simulated time, so that the motion stays right when the world runs slow.
class TrackDevice final : public Device {
 public:
  TrackDevice(PoseTrack track, std::string kind) : track_(std::move(track)), kind_(std::move(kind)) {}

  DeviceReport read(const DeviceMoment& moment) noexcept override {
    const PoseTrack::Sample sample = track_.at(moment.time);
    DeviceReport report;
    report.pose = sample.pose;
    report.twist = sample.twist;
    return report;
  }
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool immediate() const override { return true; }
  bool gives_way() const override { return false; }
  bool goes_with_world() const override { return true; }
  std::string kind() const override { return kind_; }
  double end() const { return track_.end(); }

 private:
  PoseTrack track_;
  std::string kind_;
};

constexpr const char* kPosesHeader = "time_s,device,x_m,y_m,z_m,qw,qx,qy,qz";

/// Reads the rows of one device from a file that `play --out` wrote as poses.csv: the header above, then
/// rows with time rising per device. Errors, with the line's number: a wrong header, a missing or extra
/// field, something that is not a finite number, time going back, a quaternion that is not one, no row for
/// the device.
Result<std::vector<PoseKey>> read_poses(const std::filesystem::path& file, int device);

}  // namespace slosh
