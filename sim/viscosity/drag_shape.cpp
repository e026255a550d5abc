#include "sim/viscosity/drag_shape.h"

namespace slosh {
namespace {

// A cubic lattice is alike in all directions at a support ratio of 2 where Σ w (x⁴ − 3 x²y²)/r⁴ = 0, w the
// shape times r².
constexpr double kGrowth = 1.29;  // times the support radius

// What layers that slide over each other lack, 1/0.96, in the corrected model. Where pressures are solved for
// half of it was chosen by the report: with all of it Couette's torque is 4 % too much and Poiseuille's flow
// 5 % too little, with none drag on a ball 6 % too little.
constexpr double kSlides = 1.04, kSlidesSolved = 1.02;

}  // namespace

DragShape<double> drag_shape(ParticleModel model, DragSheet sheet, double support_radius) {
  if (sheet == DragSheet::kBehind) return {1.0, 0.0};
  // ∫ shape r⁴ dr as without growth: evenly lying fluid passes on the same.
  const double level = 1.0 / (1.0 + 2.0 / 7.0 * kGrowth);
  const double by = model == ParticleModel::kIncompressible ? kSlidesSolved : kSlides;
  return {by * level, by * level * kGrowth / support_radius};
}

}  // namespace slosh
