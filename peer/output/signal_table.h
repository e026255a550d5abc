// Rows of signals.csv.
#pragma once

#include <string>

#include "peer/haptics/signal_sample.h"

namespace slosh {

std::string signals_header();
/// With its line end. What the device does not tell is nan.
std::string signals_row(const SignalSample& sample);

}  // namespace slosh
