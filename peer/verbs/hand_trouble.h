// What the person at the hands must hear of their devices.
#pragma once

#include <string>
#include <vector>

#include "peer/haptics/servo.h"
#include "scenes/scene.h"

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

}  // namespace slosh
