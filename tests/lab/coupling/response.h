// What a hand's force is made of: its impedance by frequency, and its spectrum.
#pragma once

#include <vector>

#include "tests/lab/coupling/study.h"

namespace slosh::coupling {

/// Force over velocity along x at one frequency.
struct Impedance {
  double frequency = 0.0;  ///< Hz
  double size = 0.0;       ///< N·s/m
  double phase = 0.0;      ///< rad, −π to π; 0: a damper, +π/2: a mass, −π/2: a spring
};

/// Hz, 0.1 to 30, all multiples of 0.1: what a case that is driven by tones moves the first hand with.
std::vector<double> transparency_tones();

/// The first hand's impedance from what it did and felt in the last `seconds`, a multiple of every tone's
/// period.
std::vector<Impedance> impedance(const Outcome& run, int hands, const std::vector<double>& tones,
                                 double seconds);

/// Largest distance of `rendered` from `commanded` on the complex plane, over commanded's size; 0.1 = 10 %.
double farthest_off(const std::vector<Impedance>& rendered, const std::vector<Impedance>& commanded);

/// One line of a spectrum.
struct Line {
  double frequency = 0.0;  ///< Hz
  double force = 0.0;      ///< N, amplitude
};

/// Of the first hand's force along x between `from` and `to` s, under a Hann window: 1 Hz to 500 Hz.
std::vector<Line> force_spectrum(const Outcome& run, int hands, double from, double to);

/// The largest amplitude within 1.5 Hz of `frequency`, over the largest of all; 0.01 = 1 %.
double tone_at(const std::vector<Line>& spectrum, double frequency);

}  // namespace slosh::coupling
