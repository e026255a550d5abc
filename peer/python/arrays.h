// Vectors, poses and tables between Python and here.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/math/pose.h"

namespace slosh::python {

namespace py = pybind11;

/// A pose, and how fast its frame goes where that is known.
struct HandPose {
  Pose pose;
  std::optional<glm::dvec3> velocity;          ///< m/s, world
  std::optional<glm::dvec3> angular_velocity;  ///< rad/s, world
};

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// What can be read as numbers, else nothing. Raises only what is no error of the object's: Ctrl-C may come
/// in the middle of it, and must not end as a complaint about what was being read.
std::optional<Numbers> numbers_of(const py::handle& object);
/// Three finite numbers. Raises ValueError that begins with `what`.
glm::dvec3 to_vector(const py::handle& object, const char* what);
/// w, x, y, z, within 1 % of unit length; normalised.
glm::dquat to_rotation(const py::handle& object, const char* what);
/// A Pose; 3 numbers (`rest`'s orientation); (position, orientation); 7 numbers. Raises TypeError,
/// ValueError.
HandPose to_hand_pose(const py::handle& object, const Pose& rest);

/// New arrays of doubles.
py::array_t<double> from_vector(const glm::dvec3& v);
py::array_t<double> from_rotation(const glm::dquat& q);  ///< w, x, y, z

/// Appends 7 numbers: position, then w, x, y, z.
void append(std::vector<double>& row, const Pose& pose);
void append(std::vector<double>& row, const glm::dvec3& v);
void append(std::vector<double>& row, const Wrench& wrench);
void append(std::vector<double>& row, const Twist& twist);

/// An array that takes `numbers` over without a copy.
py::array_t<double> as_array(std::vector<double>&& numbers, std::vector<py::ssize_t> shape);

/// A read-only array on memory that `owner` keeps: no copy, alive as long as the array or a view of it is.
template <class T>
py::array view(const std::shared_ptr<const void>& owner, const T* data, std::vector<py::ssize_t> shape) {
  const py::capsule base(new std::shared_ptr<const void>(owner),
                         [](void* p) { delete static_cast<std::shared_ptr<const void>*>(p); });
  py::array array(py::dtype::of<T>(), std::move(shape), data, base);
  array.attr("flags").attr("writeable") = false;
  return array;
}

}  // namespace slosh::python
