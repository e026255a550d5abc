#include "peer/python/hand.h"

#include "net/text/nearest.h"

namespace slosh::python {

Hand::Hand(const Pose& rest, const Grip& grip) : rest_(rest), script_(grip.hand_motion) {
  motion_ = PoseTrack(script_, rest_);
}

void Hand::hold(const py::object& source) {
  last_.reset();
  if (source.is_none()) {
    motion_ = std::monostate{};
  } else if (py::isinstance<py::str>(source)) {
    if (source.cast<std::string>() != "script") {
      throw py::value_error("hand: '" + source.cast<std::string>() + "' is unknown. " +
                            did_you_mean(source.cast<std::string>(), {"script"}) +
                            "None lets go, \"script\" is the scene's own motion");
    }
    motion_ = PoseTrack(script_, rest_);
  } else if (py::isinstance<Keys>(source)) {
    motion_ = PoseTrack(source.cast<const Keys&>().keys, rest_);
  } else if (py::isinstance<py::function>(source) || PyCallable_Check(source.ptr())) {
    motion_ = py::reinterpret_borrow<py::function>(source);
  } else {
    motion_ = to_hand_pose(source, rest_);
  }
}

HandleInput Hand::at(double time) {
  HandleInput input;
  input.pose = rest_;
  if (auto* track = std::get_if<PoseTrack>(&motion_)) {
    const PoseTrack::Sample sample = track->at(time);
    input.pose = sample.pose;
    input.twist = sample.twist;
    input.engaged = true;
  } else if (const auto* still = std::get_if<HandPose>(&motion_)) {
    input.pose = still->pose;
    input.twist = {still->velocity.value_or(glm::dvec3(0.0)),
                   still->angular_velocity.value_or(glm::dvec3(0.0))};
    input.engaged = true;
  } else if (calls()) {
    return asked(time);
  }
  return input;
}

HandleInput Hand::asked(double time) {
  HandleInput input;
  input.pose = rest_;
  const py::object answer = std::get<py::function>(motion_)(time);
  if (answer.is_none()) {
    last_.reset();
    return input;
  }
  const HandPose hand = to_hand_pose(answer, rest_);
  input.pose = hand.pose;
  input.engaged = true;
  const double since = time - last_time_;
  if (last_ && since > 0.0) {
    input.twist.linear = (hand.pose.position - last_->position) / since;
    input.twist.angular = rotation_between(last_->orientation, hand.pose.orientation) / since;
  }
  if (hand.velocity) input.twist.linear = *hand.velocity;
  if (hand.angular_velocity) input.twist.angular = *hand.angular_velocity;
  last_ = hand.pose;
  last_time_ = time;
  return input;
}

}  // namespace slosh::python
