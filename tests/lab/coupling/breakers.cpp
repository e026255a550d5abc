// The cases that broke schemes.
#include "tests/lab/coupling/study.h"

namespace slosh::coupling {

std::vector<Case> known_breakers() {
  std::vector<Case> cases;
  const auto add = [&](const char* name, auto&& change) {
    Case& c = cases.emplace_back();
    c.name = name;
    c.round_trip = 0.0;
    change(c);
  };
  const auto bad_link = [](Case& c) {
    c.jitter = 0.04;
    c.loss = 0.2;
  };
  add("two together", [](Case&) {});
  add("one of two moves", [](Case& c) { c.motion = Motion::kOneMoves; });
  add("opposing", [](Case& c) { c.motion = Motion::kOpposing; });
  add("loose", [](Case& c) { c.grip = "loose"; });
  add("loose, 1.5 kg", [](Case& c) { c.grip = "loose,mass=1.5"; });
  add("sudden release", [](Case& c) { c.motion = Motion::kRelease; });
  add("sudden release, loose", [](Case& c) {
    c.motion = Motion::kRelease;
    c.grip = "loose,mass=1.5";
  });
  add("200 N/m", [](Case& c) { c.stiffness = 200.0; });
  add("2000 N/m", [](Case& c) { c.stiffness = 2000.0; });
  add("2000 N/m, opposing", [](Case& c) {
    c.stiffness = 2000.0;
    c.motion = Motion::kOpposing;
  });
  add("jitter 40 ms, loss 20 %", bad_link);
  add("60 Hz packets, 70 Hz host", [](Case& c) {
    c.pose_rate = 60.0;
    c.host_rate = 70.0;
  });
  add("eight", [](Case& c) { c.hands = 8; });
  add("four, loose", [](Case& c) {
    c.hands = 4;
    c.grip = "loose";
  });
  add("mass 30 % over", [](Case& c) { c.replica_mass = 1.3; });
  add("mass 30 % under", [](Case& c) { c.replica_mass = 0.7; });
  add("fluid", [](Case& c) { c.load = Load::kFluid; });
  add("fluid, alone", [](Case& c) {
    c.load = Load::kFluid;
    c.hands = 1;
  });
  add("fluid, alone, untold", [](Case& c) {
    c.load = Load::kFluidUntold;
    c.hands = 1;
  });
  add("on a table, alone", [](Case& c) {
    c.load = Load::kTable;
    c.hands = 1;
  });
  add("on a table", [](Case& c) { c.load = Load::kTable; });
  add("carried, with fluid", [](Case& c) { c.load = Load::kCarried; });
  add("carried, with fluid, bad link", [&](Case& c) {
    bad_link(c);
    c.load = Load::kCarried;
  });
  add("two, all at once", [&](Case& c) {
    bad_link(c);
    c.stiffness = 2000.0;
    c.grip = "loose,mass=1.5";
    c.load = Load::kFluid;
  });
  add("eight, all at once", [&](Case& c) {
    bad_link(c);
    c.hands = 8;
    c.stiffness = 2000.0;
    c.grip = "loose";
    c.load = Load::kFluid;
  });
  return cases;
}

}  // namespace slosh::coupling
