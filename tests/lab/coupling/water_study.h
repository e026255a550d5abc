// One hand on the bucket of water, over a delay, in virtual time: the real world's particles and models, a
// site's replica.
#pragma once

#include <string>
#include <vector>

#include "peer/haptics/device.h"
#include "peer/replica/held_body.h"
#include "sim/math/fluid_wrench.h"
#include "sim/math/result.h"

namespace slosh::coupling {

/// To and fro, from rest to rest, from kWaterBegins on.
struct WaterWay {
  double reach = 0.03;              ///< m
  double pace = 1.35;               ///< Hz
  glm::dvec3 along{1.0, 0.0, 0.0};  ///< about 1 long
};
constexpr double kWaterBegins = 3.0;  // s
constexpr double kWaterLearnt = 4.5;  // s: from here on a swing or two were seen
constexpr double kWaterStops = 8.0;   // s
constexpr double kWaterEnds = 10.5;   // s

/// The shipped bucket with one grip, and how a hand goes with it.
struct WaterCase {
  double spacing = 0.014;  ///< m between particles
  std::string grip;        ///< parse_operator's words; empty: the hand goes its way whatever the force
  int way = 0;             ///< 0: as WaterWay has it; others 15 to 35 mm at 0.8 to 1.8 Hz, at random
  double nudge = 0.0;      ///< m by which it reaches further
};
WaterWay way_of(const WaterCase& c);

/// One tick of a hand, and what the host did in its step of 1 ms from there on.
struct WaterStep {
  double time = 0.0;  ///< s, of its begin
  Pose hand;          ///< at its begin
  Twist hand_twist;
  Wrench felt;         ///< by the hand, of its coupling to the body at the step's begin
  RigidMotion motion;  ///< at its end
  Pose handle;         ///< as the step used it
  Wrench on_hand;      ///< that the step put on it
  Wrench fluid;        ///< on the body, about its centre of mass
  bool has_model = false;
  FluidWrenchModel model;
};

/// A run at no delay.
struct WaterRun {
  WaterCase c;
  std::vector<WaterStep> steps;
  ReplicaBody body;
  ReplicaGrip grip;
};

/// The same numbers on every machine of a kind; 5 to 10 s of one core. Errors: the shipped bucket is not
/// there, or `c.grip` says nothing.
Result<WaterRun> run_water(const WaterCase& c);

/// What the hand of `reference` feels by its replica of the body, `round_trip` s (even ms) from the host,
/// tick by tick. A hand that goes its way whatever the force has the host's run of `reference` over again;
/// one that gives way has its own, and goes elsewhere by what it feels: `went`, if not null, is given where
/// it was at each tick. Errors: as above.
Result<std::vector<Wrench>> feel_water(const WaterRun& reference, double round_trip,
                                       const ReplicaTuning& tuning = {},
                                       std::vector<DeviceReport>* went = nullptr);

/// The run at no delay of a hand that goes where another went, tick by tick, whatever the force: what that
/// one should have felt. Errors: as above.
Result<WaterRun> run_water_again(const WaterCase& c, const std::vector<DeviceReport>& went);

/// RMS over a time of the difference of forces over the RMS of the reference's less its weight at rest; 1 =
/// 100 %.
double water_error(const std::vector<Wrench>& felt, const WaterRun& reference, double begin = kWaterBegins,
                   double end = kWaterEnds);
/// The same of the reference's own force, known `round_trip` s late: what who knows nothing of water would
/// have.
double late_error(const WaterRun& reference, double round_trip);
/// That RMS of the reference's, N.
double water_force(const WaterRun& reference, double begin = kWaterBegins, double end = kWaterEnds);

/// What is left of the fluid's force in a run at no delay where the best of a family of models is taken off
/// that all of the run's own numbers were used to find, in units of water_force(). No replica can count on
/// less by such a model.
struct WaterSplit {
  double rigid = 0.0;  ///< a mass and a damper an axis
  double modes = 0.0;  ///< and a slosh mode an axis
  double lifts = 0.0;  ///< and what swings to and fro rises on a bowl (bowl_force)
};
WaterSplit split_water(const WaterRun& run);

}  // namespace slosh::coupling
