// The parts of the module, one file each.
#pragma once

#include <pybind11/pybind11.h>

namespace slosh::python {

void bind_values(pybind11::module_& m);     ///< Pose, Keys, Run, BodyState, GripState, Measurement
void bind_scene(pybind11::module_& m);      ///< Scene and its parts, load_scene, check, plan
void bind_builder(pybind11::module_& m);    ///< Mesh, shapes, SceneBuilder
void bind_world(pybind11::module_& m);      ///< World
void bind_recording(pybind11::module_& m);  ///< Recording, replay
void bind_remote(pybind11::module_& m);     ///< Remote, join

}  // namespace slosh::python
