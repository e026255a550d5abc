#include "sim/pressure/wall_layers.h"

#include <algorithm>
#include <iterator>

#include "sim/passes/density/corrected_state.h"
#include "sim/passes/pressure_force/pair_pressure.h"

namespace slosh {
namespace {

struct Read {
  double support_ratio, layers;
};

// Of both models, at 8, 10 and 12.5 mm: each by itself asks for up to 0.03 more or less.
constexpr Read kRead[] = {{1.5, 1.03}, {1.75, 1.05}, {2.0, 1.1}, {2.25, 1.13}, {2.5, 1.17}, {2.6, 1.2}};

}  // namespace

double thick_layers(double support_ratio) {
  const Read* above = std::find_if(std::begin(kRead), std::end(kRead),
                                   [&](const Read& read) { return read.support_ratio >= support_ratio; });
  if (above == std::end(kRead)) return (above - 1)->layers;
  if (above == std::begin(kRead)) return above->layers;
  const Read& below = above[-1];
  const double share = (above->support_ratio - support_ratio) / (above->support_ratio - below.support_ratio);
  return above->layers + share * (below.layers - above->layers);
}

float wall_layer(float noise, float viscosity, double support_ratio) {
  const float thick = 1.0f - artificial_viscosity_left(noise, viscosity) / noise;
  return (1.0f + (static_cast<float>(thick_layers(support_ratio)) - 1.0f) * thick) / kWallShare;
}

}  // namespace slosh
