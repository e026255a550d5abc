// Small values that calls take and give.
#include <pybind11/stl.h>

#include <cmath>

#include "peer/python/bindings.h"
#include "peer/python/hand.h"
#include "peer/python/run_table.h"
#include "sim/instruments.h"

namespace slosh::python {
namespace {

HandPose make_pose(const py::object& position, const py::object& orientation, const py::object& velocity,
                   const py::object& angular_velocity) {
  HandPose pose;
  pose.pose = {to_vector(position, "position"), to_rotation(orientation, "orientation")};
  if (!velocity.is_none()) pose.velocity = to_vector(velocity, "velocity");
  if (!angular_velocity.is_none()) pose.angular_velocity = to_vector(angular_velocity, "angular_velocity");
  return pose;
}

Keys make_keys(const Numbers& times, const Numbers& positions, const py::object& orientations) {
  const py::ssize_t count = times.size();
  if (times.ndim() != 1 || count < 1) throw py::value_error("times: (n,) seconds, n at least 1");
  if (positions.ndim() != 2 || positions.shape(0) != count || positions.shape(1) != 3)
    throw py::value_error("positions: (n, 3) metres, a row a time");
  std::optional<Numbers> turns;
  if (!orientations.is_none()) {
    turns = numbers_of(orientations);
    if (!turns || turns->ndim() != 2 || turns->shape(0) != count || turns->shape(1) != 4)
      throw py::value_error("orientations: (n, 4) unit quaternions w, x, y, z, a row a time");
  }
  Keys keys;
  for (py::ssize_t i = 0; i < count; ++i) {
    PoseKey key;
    key.time = times.at(i);
    key.pose.position = {positions.at(i, 0), positions.at(i, 1), positions.at(i, 2)};
    if (!std::isfinite(key.time) || !std::isfinite(glm::length(key.pose.position)))
      throw py::value_error("times, positions: finite numbers; row " + std::to_string(i) + " is not");
    if (i > 0 && key.time <= keys.keys.back().time)
      throw py::value_error("times: rising; row " + std::to_string(i) + " is not later than the one before");
    if (turns) {
      const glm::dquat q(turns->at(i, 0), turns->at(i, 1), turns->at(i, 2), turns->at(i, 3));
      if (!(std::abs(glm::length(q) - 1.0) <= 0.01))
        throw py::value_error("orientations: unit quaternions; row " + std::to_string(i) + " is not");
      key.pose.orientation = glm::normalize(q);
    }
    keys.keys.push_back(key);
  }
  return keys;
}

py::array_t<double> key_times(const Keys& keys) {
  std::vector<double> out;
  for (const PoseKey& key : keys.keys) out.push_back(key.time);
  const auto rows = static_cast<py::ssize_t>(out.size());
  return as_array(std::move(out), {rows});
}

py::array_t<double> key_poses(const Keys& keys) {
  std::vector<double> out;
  for (const PoseKey& key : keys.keys) append(out, key.pose);
  return as_array(std::move(out), {static_cast<py::ssize_t>(keys.keys.size()), 7});
}

HandPose key_at(const Keys& keys, double time) {
  PoseTrack track(keys.keys, Pose{});
  const PoseTrack::Sample sample = track.at(time);
  return {sample.pose, sample.twist.linear, sample.twist.angular};
}

py::object optional_vector(const std::optional<glm::dvec3>& v) {
  return v ? py::object(from_vector(*v)) : py::none();
}

HandPose composed(const HandPose& outer, const HandPose& inner) {
  return {compose(outer.pose, inner.pose), {}, {}};
}

}  // namespace

void bind_values(py::module_& m) {
  py::class_<HandPose>(
      m, "Pose",
      "A place and a turning of a frame in the world, and how fast it goes where that is known.\n\n"
      "position: (3,) m. orientation: (4,) unit quaternion w, x, y, z. velocity: (3,) m/s and\n"
      "angular_velocity: (3,) rad/s, world axes, or None: found from one call to the next.\n"
      "`a @ b` first applies b, then a.")
      .def(py::init(&make_pose), py::arg("position") = py::make_tuple(0.0, 0.0, 0.0),
           py::arg("orientation") = py::make_tuple(1.0, 0.0, 0.0, 0.0), py::arg("velocity") = py::none(),
           py::arg("angular_velocity") = py::none())
      .def_static(
          "turned",
          [](const py::object& axis, double angle, const py::object& position) {
            const glm::dvec3 a = to_vector(axis, "axis");
            if (!(glm::length(a) > 0.0)) throw py::value_error("axis: longer than 0");
            return HandPose{
                {to_vector(position, "position"), glm::angleAxis(angle, glm::normalize(a))}, {}, {}};
          },
          py::arg("axis"), py::arg("angle"), py::arg("position") = py::make_tuple(0.0, 0.0, 0.0),
          "A turn by `angle` rad about `axis` (3,), at `position` (3,) m.")
      .def_property_readonly(
          "position", [](const HandPose& p) { return from_vector(p.pose.position); }, "(3,) m")
      .def_property_readonly(
          "orientation", [](const HandPose& p) { return from_rotation(p.pose.orientation); },
          "(4,) w, x, y, z")
      .def_property_readonly(
          "velocity", [](const HandPose& p) { return optional_vector(p.velocity); }, "(3,) m/s or None")
      .def_property_readonly(
          "angular_velocity", [](const HandPose& p) { return optional_vector(p.angular_velocity); },
          "(3,) rad/s or None")
      .def(
          "inverse", [](const HandPose& p) { return HandPose{inverse(p.pose), {}, {}}; },
          "The pose that undoes this.")
      .def(
          "transform",
          [](const HandPose& p, const py::object& point) {
            return from_vector(transform_point(p.pose, to_vector(point, "point")));
          },
          py::arg("point"), "World coordinates (3,) m of a point (3,) m of the frame.")
      .def("__matmul__", &composed, py::arg("inner"))
      .def("__repr__", [](const HandPose& p) {
        return "slosh.Pose(" + py::repr(py::list(from_vector(p.pose.position))).cast<std::string>() + ", " +
               py::repr(py::list(from_rotation(p.pose.orientation))).cast<std::string>() + ")";
      });

  py::class_<Keys>(
      m, "Keys",
      "A motion through keys: times (n,) s rising, positions (n, 3) m, orientations (n, 4) w, x, y, z or\n"
      "None (no turning). Between keys each coordinate follows a monotone cubic: velocities have no\n"
      "jumps, nothing overshoots. Before the first and after the last key it stands.")
      .def(py::init(&make_keys), py::arg("times"), py::arg("positions"), py::arg("orientations") = py::none())
      .def_property_readonly("times", &key_times, "(n,) s")
      .def_property_readonly("poses", &key_poses, "(n, 7): x, y, z m, then w, x, y, z")
      .def("at", &key_at, py::arg("time"), "Pose with its velocities at `time` (s).")
      .def("__len__", [](const Keys& k) { return k.keys.size(); });

  py::class_<Run>(m, "Run", "What World.run brought: n kept steps, G grips, B bodies, in the scene's order.")
      .def_readonly("time", &Run::time, "(n,) simulated s at the end of each step")
      .def_readonly(
          "wrenches", &Run::wrenches,
          "(n, G, 6): force N and torque N·m on the hand, about the handle, world axes; mean over the step")
      .def_readonly("handles", &Run::handles, "(n, G, 7): the pose that the step used; x, y, z m, w, x, y, z")
      .def_readonly("body_poses", &Run::body_poses, "(n, B, 7): of the mesh frame; x, y, z m, w, x, y, z")
      .def_readonly("body_twists", &Run::body_twists,
                    "(n, B, 6): velocity of the centre of mass m/s, angular velocity rad/s, world axes")
      .def_readonly("body_centers", &Run::body_centers, "(n, B, 3): centre of mass, m")
      .def_readonly("fluid_wrenches", &Run::fluid_wrenches,
                    "(n, B, 6): force N and torque N·m of the fluid on the body, about its centre of mass; 0 "
                    "for fixed\n"
                    "bodies that are not `measured`")
      .def_readonly("status", &Run::status, "What the steps reported, in words; empty while all is well")
      .def_readonly("slipped", &Run::slipped, "s that a run in real time fell behind the clock");

  py::class_<BodyState>(m, "BodyState", "A body at one moment. A copy.")
      .def_property_readonly(
          "pose", [](const BodyState& b) { return HandPose{b.pose, {}, {}}; }, "Pose of the mesh frame")
      .def_property_readonly(
          "velocity", [](const BodyState& b) { return from_vector(b.twist.linear); },
          "(3,) m/s, of the centre of mass")
      .def_property_readonly(
          "angular_velocity", [](const BodyState& b) { return from_vector(b.twist.angular); },
          "(3,) rad/s, world axes")
      .def_property_readonly(
          "center_of_mass", [](const BodyState& b) { return from_vector(b.center_of_mass); }, "(3,) m, world")
      .def_property_readonly(
          "fluid_force", [](const BodyState& b) { return from_vector(b.fluid.force); },
          "(3,) N, of the fluid on the body, mean over the last step")
      .def_property_readonly(
          "fluid_torque", [](const BodyState& b) { return from_vector(b.fluid.torque); },
          "(3,) N·m, about the centre of mass");

  py::class_<GripState>(m, "GripState", "A grip and its hand at one moment. A copy.")
      .def_property_readonly(
          "pose", [](const GripState& g) { return HandPose{g.pose, g.twist.linear, g.twist.angular}; },
          "Pose of the grip on its body, with its velocities")
      .def_property_readonly(
          "handle", [](const GripState& g) { return HandPose{g.handle, {}, {}}; },
          "Pose of the hand that the last step used")
      .def_property_readonly(
          "force", [](const GripState& g) { return from_vector(g.on_hand.force); },
          "(3,) N on the hand: a held weight is negative in y")
      .def_property_readonly(
          "torque", [](const GripState& g) { return from_vector(g.on_hand.torque); },
          "(3,) N·m on the hand, about the handle");

  py::class_<Measurement>(m, "Measurement", "What World.measure reads. A copy.")
      .def_readonly("time", &Measurement::time, "simulated s")
      .def_property_readonly(
          "particles", [](const Measurement& x) { return x.fluid.particles; }, "still in the world")
      .def_property_readonly(
          "spilled", [](const Measurement& x) { return x.fluid.spilled; },
          "particles that left the domain over its edge")
      .def_property_readonly(
          "lost", [](const Measurement& x) { return x.fluid.lost; },
          "particles that were not finite any more; by the published model, whose walls do not hold, all "
          "that "
          "left")
      .def_property_readonly(
          "mass", [](const Measurement& x) { return x.fluid.mass; }, "kg of fluid")
      .def_property_readonly(
          "momentum", [](const Measurement& x) { return from_vector(x.fluid.momentum); }, "(3,) kg·m/s")
      .def_property_readonly(
          "center_of_mass", [](const Measurement& x) { return from_vector(x.fluid.center); },
          "(3,) m, of the fluid")
      .def_property_readonly(
          "kinetic_energy", [](const Measurement& x) { return x.fluid.kinetic_energy; }, "J")
      .def_property_readonly(
          "max_speed", [](const Measurement& x) { return x.fluid.max_speed; }, "m/s")
      .def_property_readonly(
          "max_compression", [](const Measurement& x) { return x.fluid.max_compression; },
          "largest density over rest density, less 1")
      .def_readonly("in_solids", &Measurement::in_solids,
                    "particles whose centre is deeper than a twentieth of a spacing inside a body")
      .def_property_readonly(
          "in_bodies", [](const Measurement& x) { return x.in_body; }, "the same, a body each: list[int]")
      .def_property_readonly(
          "levels", [](const Measurement& x) { return x.levels; },
          "m along up, a gauge each: list[float]; nan where no fluid is")
      .def_property_readonly(
          "pressures", [](const Measurement& x) { return x.pressures; },
          "Pa at each gauge: list[float]; nan outside of fluid")
      .def_property_readonly(
          "masses", [](const Measurement& x) { return x.masses; }, "kg in each region: list[float]");
}

}  // namespace slosh::python
