#include "peer/haptics/shared_handle.h"

#include <algorithm>
#include <cmath>

namespace slosh {
namespace {

constexpr double kFollow = 30.0;      // 1/s: 95 % of a step within 0.16 s
constexpr double kMaxGap = 0.08;      // m that it is drawn by at most: with kFollow / 2 that is 1.2 m/s
constexpr double kMaxTurn = 0.3;      // rad, so 4.5 rad/s
constexpr double kHomeSeconds = 1.0;  // at least
constexpr double kHomeSpeed = 0.25;   // m/s, in the mean
constexpr double kHomeTurning = 1.0;  // rad/s

glm::dvec3 at_most(const glm::dvec3& v, double length) {
  const double now = glm::length(v);
  return now > length ? v * (length / now) : v;
}

}  // namespace

SharedHandleDevice::SharedHandleDevice(std::unique_ptr<Device> script, std::shared_ptr<SharedHandle> lent)
    : script_(std::move(script)), lent_(std::move(lent)) {}

DeviceReport SharedHandleDevice::read(const DeviceMoment& moment) noexcept {
  DeviceReport report = script_->read(moment);
  const bool began_again = moment.time < time_;
  const double elapsed = time_ < 0.0 || began_again ? 0.0 : moment.time - time_;
  time_ = moment.time;
  if (began_again) left_ = 0.0;  // the world is back at its start, and so is who goes home
  if (lent_->wish.update()) {
    const SharedHandle::Wish& newest = lent_->wish.front();
    if (wish_.taken && !newest.taken && !began_again) begin_return(report.pose);
    if (newest.taken && !wish_.taken && left_ <= 0.0) {
      pose_ = report.pose;
      twist_ = report.twist;
    }
    wish_ = newest;
  }
  if (wish_.taken) {
    follow(elapsed);
    report.pose = pose_;
    report.twist = twist_;
  } else if (left_ > 0.0) {
    report = on_the_way_home(report, elapsed);
  }
  lent_->now.back() = report.pose;
  lent_->now.publish();
  return report;
}

/// The exact solution over `elapsed`, so that no time is too long for it.
void SharedHandleDevice::follow(double elapsed) noexcept {
  const double fade = std::exp(-kFollow * elapsed);
  const glm::dvec3 gap = at_most(pose_.position - wish_.pose.position, kMaxGap);
  const glm::dvec3 target = pose_.position - gap;
  const glm::dvec3 push = twist_.linear + kFollow * gap;
  pose_.position = target + fade * (gap + elapsed * push);
  twist_.linear = fade * (twist_.linear - kFollow * elapsed * push);

  const glm::dvec3 turn = at_most(rotation_between(wish_.pose.orientation, pose_.orientation), kMaxTurn);
  const glm::dquat aim = rotate_by(pose_.orientation, -turn);
  const glm::dvec3 twist = twist_.angular + kFollow * turn;
  pose_.orientation = rotate_by(aim, fade * (turn + elapsed * twist));
  twist_.angular = fade * (twist_.angular - kFollow * elapsed * twist);
}

void SharedHandleDevice::begin_return(const Pose& script) noexcept {
  away_ = pose_.position - script.position;
  turned_ = rotation_between(script.orientation, pose_.orientation);
  way_home_ = std::max({kHomeSeconds, glm::length(away_) / kHomeSpeed, glm::length(turned_) / kHomeTurning});
  left_ = way_home_;
}

DeviceReport SharedHandleDevice::on_the_way_home(DeviceReport script, double elapsed) noexcept {
  left_ = std::max(0.0, left_ - elapsed);
  const double s = left_ / way_home_;
  const double share = s * s * (3.0 - 2.0 * s);
  const double change = left_ > 0.0 ? -6.0 * s * (1.0 - s) / way_home_ : 0.0;
  script.pose.position += share * away_;
  script.pose.orientation = rotate_by(script.pose.orientation, share * turned_);
  script.twist.linear += change * away_;
  script.twist.angular += change * turned_;
  pose_ = script.pose;
  twist_ = script.twist;
  return script;
}

}  // namespace slosh
