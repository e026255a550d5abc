#include "sim/viscosity/drag_shape.h"

namespace slosh {
namespace {

// A cubic lattice is alike in all directions at a support ratio of 2 where Σ w (x⁴ − 3 x²y²)/r⁴ = 0, w the
// shape times r².
constexpr double kGrowth = 1.29;  // times the support radius

constexpr double kSlides = 1.04;  // what sliding layers lack of the viscous stress, 1/0.96

}  // namespace

DragShape<double> drag_shape(DragLayer layer, double support_radius) {
  if (layer == DragLayer::kBehind) return {1.0, 0.0};
  // ∫ shape r⁴ dr as without growth: evenly lying fluid passes on the same.
  const double level = 1.0 / (1.0 + 2.0 / 7.0 * kGrowth);
  return {kSlides * level, kSlides * level * kGrowth / support_radius};
}

}  // namespace slosh
