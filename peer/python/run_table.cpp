#include "peer/python/run_table.h"

namespace slosh::python {

Run to_run(RunTable&& t) {
  const auto rows = static_cast<py::ssize_t>(t.time.size());
  const auto grips = static_cast<py::ssize_t>(t.grips);
  const auto bodies = static_cast<py::ssize_t>(t.bodies);
  Run run;
  run.time = as_array(std::move(t.time), {rows});
  run.wrenches = as_array(std::move(t.wrenches), {rows, grips, 6});
  run.handles = as_array(std::move(t.handles), {rows, grips, 7});
  run.body_poses = as_array(std::move(t.poses), {rows, bodies, 7});
  run.body_twists = as_array(std::move(t.twists), {rows, bodies, 6});
  run.body_centers = as_array(std::move(t.centers), {rows, bodies, 3});
  run.fluid_wrenches = as_array(std::move(t.fluid), {rows, bodies, 6});
  run.status = status_text(t.status);
  run.slipped = t.slipped;
  return run;
}

}  // namespace slosh::python
