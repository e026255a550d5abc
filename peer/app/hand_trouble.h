// What the person at the hands must hear of their devices.
#pragma once

#include <string>
#include <vector>

#include "peer/haptics/servo.h"
#include "scenes/scene.h"
#include "sim/math/format.h"

namespace slosh {

/// What is not as it should be: the files' problem, when there is one, and a sentence for each device that is
/// out of use. `scene` is the servo's. By the thread that may ask the servo about devices.
inline std::vector<std::string> run_troubles(const std::string& files, const Servo& servo,
                                             const Scene& scene) {
  std::vector<std::string> troubles;
  if (!files.empty()) troubles.push_back(files);
  for (std::size_t i = 0; i < servo.devices(); ++i) {
    if (const std::string why = servo.failure(i); !why.empty())
      troubles.push_back("the device in " + scene.grips[i].name + " is out of use: " + why);
  }
  return troubles;
}

/// The same in one line; empty when all is well.
inline std::string run_trouble(const std::string& files, const Servo& servo, const Scene& scene) {
  std::string all;
  for (const std::string& each : run_troubles(files, servo, scene)) all += (all.empty() ? "" : "; ") + each;
  return all;
}

/// What the person should know before holding grip `i` with an open device: gains that the device does not
/// hold though scene or file ask for them.
inline std::vector<std::string> hand_notes(const Scene& scene, std::size_t i, const Device& device) {
  std::vector<std::string> notes = device.warnings();
  const Grip& grip = scene.grips[i];
  const DeviceLimits limits = device.limits();
  if (!device.gives_way() || (grip.stiffness <= limits.max_stiffness && grip.damping <= limits.max_damping))
    return notes;
  notes.push_back(grip.name +
                  format(" asks for %.4g N/m and %.4g N·s/m, and the %s holds at most %.4g and %.3g",
                         grip.stiffness, grip.damping, device.kind().c_str(), limits.max_stiffness,
                         limits.max_damping) +
                  ": it feels softer than the body is held. `slosh devices --help` says what decides that");
  return notes;
}

}  // namespace slosh
