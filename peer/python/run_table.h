// What a run brought, a row a kept step.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "peer/python/arrays.h"
#include "sim/snapshot.h"

namespace slosh::python {

/// Columns side by side; taken out once, as arrays without a copy.
struct RunTable {
  std::size_t grips = 0;
  std::size_t bodies = 0;
  std::vector<double> time;      ///< s
  std::vector<double> wrenches;  ///< 6 a grip
  std::vector<double> handles;   ///< 7 a grip
  std::vector<double> poses;     ///< 7 a body
  std::vector<double> twists;    ///< 6 a body
  std::vector<double> centers;   ///< 3 a body
  std::vector<double> fluid;     ///< 6 a body
  std::uint32_t status = 0;      ///< StatusBits of all steps
  double slipped = 0.0;          ///< s that a run in real time fell behind

  void add(const BodySnapshot& now) {
    time.push_back(now.time);
    for (const GripState& grip : now.grips) {
      append(wrenches, grip.on_hand);
      append(handles, grip.handle);
    }
    for (const BodyState& body : now.bodies) {
      append(poses, body.pose);
      append(twists, body.twist);
      append(centers, body.center_of_mass);
      append(fluid, body.fluid);
    }
  }
};

/// slosh.Run
struct Run {
  py::object time, wrenches, handles, body_poses, body_twists, body_centers, fluid_wrenches;
  std::string status;
  double slipped = 0.0;
};

/// With Python's lock.
Run to_run(RunTable&& table);

}  // namespace slosh::python
