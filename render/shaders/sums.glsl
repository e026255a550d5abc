// Sums by atomics, in whole numbers: they come out the same in whatever order they are added.
const float kChordSteps = 4194304.0;  // a metre: up to 1024 m, to a quarter of a micrometre
const float kDimmingSteps = 16384.0;  // of optical depth
const float kMaxDimming = 200.0;     // of one particle: nothing is left of the light long before
const float kShareSteps = 65536.0;    // of a particle's share
