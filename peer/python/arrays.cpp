#include "peer/python/arrays.h"

#include <cmath>

namespace slosh::python {
namespace {

/// Empty where that is no list of numbers.
std::vector<double> to_numbers(const py::handle& object) {
  const std::optional<Numbers> array = numbers_of(object);
  if (!array) return {};
  return {array->data(), array->data() + array->size()};
}

std::string shown(const py::handle& object) {
  std::string text = py::repr(object).cast<std::string>();
  if (text.size() > 80) text = text.substr(0, 77) + "...";
  return text;
}

glm::dquat checked_rotation(double w, double x, double y, double z, const char* what) {
  const glm::dquat q(w, x, y, z);
  const double length = glm::length(q);
  if (!(std::abs(length - 1.0) <= 0.01)) {
    throw py::value_error(std::string(what) +
                          ": not a rotation: a unit quaternion is w, x, y, z with length 1, this has " +
                          std::to_string(length));
  }
  return glm::normalize(q);
}

}  // namespace

std::optional<Numbers> numbers_of(const py::handle& object) {
  try {  // Numbers::ensure would swallow all that is raised
    return Numbers(py::reinterpret_borrow<py::object>(object));
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_Exception)) throw;
    return {};
  }
}

glm::dvec3 to_vector(const py::handle& object, const char* what) {
  const std::vector<double> n = to_numbers(object);
  if (n.size() != 3 || !std::isfinite(n[0] + n[1] + n[2]))
    throw py::value_error(std::string(what) + ": wants three finite numbers, not " + shown(object));
  return {n[0], n[1], n[2]};
}

glm::dquat to_rotation(const py::handle& object, const char* what) {
  const std::vector<double> n = to_numbers(object);
  if (n.size() != 4)
    throw py::value_error(std::string(what) + ": wants a unit quaternion w, x, y, z, not " + shown(object));
  return checked_rotation(n[0], n[1], n[2], n[3], what);
}

HandPose to_hand_pose(const py::handle& object, const Pose& rest) {
  if (py::isinstance<HandPose>(object)) return object.cast<HandPose>();
  const std::vector<double> n = to_numbers(object);
  if (n.size() == 3) return {{to_vector(object, "pose"), rest.orientation}, {}, {}};
  if (n.size() == 7) {
    const glm::dvec3 position(n[0], n[1], n[2]);
    if (!std::isfinite(n[0] + n[1] + n[2]))
      throw py::value_error("pose: wants finite numbers, not " + shown(object));
    return {{position, checked_rotation(n[3], n[4], n[5], n[6], "pose")}, {}, {}};
  }
  if (py::isinstance<py::sequence>(object) && py::len(object) == 2) {
    const auto pair = py::reinterpret_borrow<py::sequence>(object);
    return {{to_vector(pair[0], "pose: position"), to_rotation(pair[1], "pose: orientation")}, {}, {}};
  }
  throw py::type_error(
      "pose: wants a slosh.Pose, 3 numbers, (position, quaternion), or 7 numbers x, y, z, w, x, y, z; not " +
      shown(object));
}

py::array_t<double> from_vector(const glm::dvec3& v) {
  py::array_t<double> out(3);
  for (int i = 0; i < 3; ++i) out.mutable_at(i) = v[i];
  return out;
}

py::array_t<double> from_rotation(const glm::dquat& q) {
  py::array_t<double> out(4);
  const double parts[] = {q.w, q.x, q.y, q.z};
  for (int i = 0; i < 4; ++i) out.mutable_at(i) = parts[i];
  return out;
}

void append(std::vector<double>& row, const glm::dvec3& v) {
  for (int i = 0; i < 3; ++i) row.push_back(v[i]);
}

void append(std::vector<double>& row, const Pose& pose) {
  append(row, pose.position);
  for (const double part : {pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z})
    row.push_back(part);
}

void append(std::vector<double>& row, const Wrench& wrench) {
  append(row, wrench.force);
  append(row, wrench.torque);
}

void append(std::vector<double>& row, const Twist& twist) {
  append(row, twist.linear);
  append(row, twist.angular);
}

py::array_t<double> as_array(std::vector<double>&& numbers, std::vector<py::ssize_t> shape) {
  auto* kept = new std::vector<double>(std::move(numbers));
  const py::capsule base(kept, [](void* p) { delete static_cast<std::vector<double>*>(p); });
  return py::array_t<double>(std::move(shape), kept->data(), base);
}

}  // namespace slosh::python
