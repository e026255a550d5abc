// Hands at several sites on one body, in virtual time: how a coupling fares over a delay.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "peer/replica/body_replica.h"
#include "sim/math/pose.h"

namespace slosh::coupling {

/// What makes the force at a site.
enum class Scheme {
  kZeroDelay,   ///< what the others are measured against: host and hands at one place, at 1 kHz
  kHostForce,   ///< the host's coupling force, held: the published scheme, whose host has the devices
  kPeerSpring,  ///< a spring and damper to the host's newest body
  kReplica,     ///< peer/replica
};
/// How the hands want to go: all alike, the first alone, every other one the other way, or the first alone,
/// which lets go at its fastest.
enum class Motion { kTogether, kOneMoves, kOpposing, kRelease };
/// What acts on the body besides hands: nothing; drag and 1.5 kg of fluid that swings at 1.5 Hz, of which the
/// host says a model as added mass and drag; the same, and it says none; its weight, and a table that it
/// starts on; a syrup that drags by 40 N·s/m, of which the host says a model, or none; its weight and the
/// fluid that swings, with its model; or the body is the shipped bucket with its water, particles and all.
enum class Load { kNone, kFluid, kFluidUntold, kTable, kSyrup, kSyrupUntold, kCarried, kBucket };

struct Bucket;

struct Case {
  std::string name;
  int hands = 2;              ///< ≥ 1, each at a site of its own
  double stiffness = 1000.0;  ///< N/m; 30 ms of it damp, and a hundredth m² turns
  Motion motion = Motion::kTogether;
  Load load = Load::kNone;
  std::string grip = "tight";                      ///< parse_operator's words
  double round_trip = 0.1;                         ///< s, the network's
  double jitter = 0.0;                             ///< s, 0 to this much on top of each way
  double loss = 0.0;                               ///< probability, each way
  double pose_rate = 500.0;                        ///< Hz
  double host_rate = 500.0;                        ///< Hz, steps and states
  double replica_mass = 1.0;                       ///< times the body's: how wrong the replica is
  double most_damping = 100.0;                     ///< N·s/m that the devices hold
  double seconds = 12.0;                           ///< the hands move for 4 of them, from 0.5 on
  double body_mass = 2.5;                          ///< kg, where it is no bucket
  std::shared_ptr<const Bucket> bucket = nullptr;  ///< load_bucket()'s, where it is
  /// Hz: not empty, and the first hand moves along x by a sum of these from the start to the end, each at
  /// 0.03 m/s but at most 8 mm; the others stand.
  std::vector<double> tones;
};

enum class Verdict {
  kStable,      ///< what swings after the hands stopped dies away
  kLimitCycle,  ///< it does not
  kDiverged,    ///< beyond 2 kN or 3 m
};

struct Outcome {
  Verdict verdict = Verdict::kStable;
  double generated = 0.0;    ///< J that came out beyond what all persons and a sinking weight had put in, the
                             ///< most at any moment
  double peak = 0.0;         ///< N, largest force on a hand
  double swing = 0.0;        ///< m/s, rms over all hands in the last second
  double fired = 0.0;        ///< share of ticks in which a site's passivity controller acted
  bool fell_back = false;    ///< a site went over to the damped spring
  int steps = 0;             ///< times that a hand's force changed by over 1 N within 2 ms, over all hands
  std::vector<Wrench> felt;  ///< each tick's, hand by hand
  std::vector<Pose> handles;  ///< each tick's, of the first hand
};

/// Runs `c`: the same numbers on every machine of a kind. About 0.01 s a hand and second of 1 kHz, and half a
/// second more a second of a bucket.
Outcome run(const Case& c, Scheme scheme, const ReplicaTuning& tuning = {});

/// RMS of the forces' difference over the RMS of the reference's, both over all hands; 1 = 100 %.
double force_error(const Outcome& felt, const Outcome& reference);

/// s of round trip at which theory sees the peer's spring go: Gil & Hulin's K < (b + B)/(T/2 + t_d), b the
/// hand's damping.
double spring_bound(const Case& c);

const char* word(Verdict verdict);
const char* word(Scheme scheme);

/// The cases that broke schemes (the study of the coupling at a distance), at a round trip of 0.
std::vector<Case> known_breakers();

}  // namespace slosh::coupling
