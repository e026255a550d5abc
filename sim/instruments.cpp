#include "sim/instruments.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/math/distance_field.h"

namespace slosh {
namespace {

constexpr std::uint8_t kRetired = 255;
/// The fluid ends where its smoothed volume falls below a half.
constexpr double kSurface = 0.5;
constexpr double kReach = 2.0;  // spacings, of that smoothing
/// A place at a wall has a half of what lies in the open; beyond that it is outside.
constexpr double kInFluid = 0.3;
constexpr double kLevelSteps = 10.0;  // a spacing
/// Spacings: a drop alone lies on a surface to some hundredths.
constexpr double kInSolid = 0.05;

/// Wendland's C2 kernel in 3-D of reach h, times volume.
double smoothed(double r, double h, double volume) {
  const double q = r / h;
  if (q >= 1.0) return 0.0;
  const double left = 1.0 - q;
  return volume * 21.0 / (2.0 * 3.14159265358979323846 * h * h * h) * left * left * left * left *
         (4.0 * q + 1.0);
}

bool has_field(const DistanceField& field) {
  return !field.distance.empty();
}

}  // namespace

Instruments::Instruments(const Scene& scene, const SampledScene& sampled)
    : spacing_(sampled.spacing),
      body_fields_(sampled.distance_fields),
      region_fields_(sampled.region_fields),
      gauges_(scene.gauges) {
  if (glm::length(scene.gravity) > 0.0) up_ = -glm::normalize(scene.gravity);
  const double volume = spacing_ * spacing_ * spacing_;
  for (const Fluid& fluid : scene.fluids) particle_mass_.push_back(fluid.rest_density * volume);
  for (std::size_t b = 0; b < body_fields_.size(); ++b) {
    if (has_field(body_fields_[b])) bodies_.push_back({static_cast<int>(b), Pose{}, &body_fields_[b]});
  }
  for (std::size_t r = 0; r < region_fields_.size(); ++r) {
    regions_.push_back({scene.regions[r].body, scene.regions[r].pose, &region_fields_[r]});
  }
}

template <class Found>
void Instruments::find_inside(const Solid& solid, double deeper, Found&& found) const {
  Pose pose = solid.pose;
  if (solid.body >= 0)
    pose = compose(snapshot_.rigid.bodies[static_cast<std::size_t>(solid.body)].pose, pose);
  const glm::mat3 turn = glm::mat3(glm::transpose(glm::mat3_cast(pose.orientation)));
  const glm::vec3 origin(pose.position);
  const DistanceFieldView view = solid.field->view();
  const glm::vec3 low = view.origin;
  const glm::vec3 high = view.origin + view.cell * glm::vec3(view.size - 1);
  for (std::size_t i = 0; i < snapshot_.positions.size(); ++i) {
    if (snapshot_.fluid_index[i] == kRetired) continue;
    const glm::vec3 p = turn * (snapshot_.positions[i] - origin);
    if (glm::any(glm::lessThan(p, low)) || glm::any(glm::greaterThan(p, high))) continue;
    if (static_cast<double>(sample_distance(view, p).distance) < -deeper) found(i);
  }
}

double fluid_level(const Snapshot& snapshot, const glm::dvec3& at, const glm::dvec3& up, double spacing) {
  struct Near {
    double height, aside;  // m along the line; squared m from it
  };
  const double h = kReach * spacing;
  std::vector<Near> near;
  double top = -std::numeric_limits<double>::infinity();
  double bottom = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < snapshot.positions.size(); ++i) {
    if (snapshot.fluid_index[i] == kRetired) continue;
    const glm::dvec3 p(snapshot.positions[i]);
    const double height = glm::dot(p, up);
    const glm::dvec3 aside = (p - at) - glm::dot(p - at, up) * up;
    const double squared = glm::dot(aside, aside);
    if (squared >= h * h) continue;
    near.push_back({height, squared});
    top = std::max(top, height);
    bottom = std::min(bottom, height);
  }
  std::sort(near.begin(), near.end(), [](const Near& a, const Near& b) { return a.height > b.height; });
  const double volume = spacing * spacing * spacing;
  const double step = spacing / kLevelSteps;
  double above = 0.0;
  std::size_t first = 0;
  for (double s = top + h; s >= bottom - h; s -= step) {
    while (first < near.size() && near[first].height > s + h) ++first;
    double here = 0.0;
    for (std::size_t k = first; k < near.size() && near[k].height > s - h; ++k) {
      const double d = near[k].height - s;
      here += smoothed(std::sqrt(d * d + near[k].aside), h, volume);
    }
    if (here >= kSurface) return s + step * (here - kSurface) / std::max(here - above, 1e-12);
    above = here;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// The smoothed mean of what the particles around have: right to second order within fluid, that of the
/// nearest layers at its edge.
double Instruments::pressure(const glm::dvec3& at) const {
  const double h = kReach * spacing_;
  const double volume = spacing_ * spacing_ * spacing_;
  double sum = 0.0, weights = 0.0;
  for (std::size_t i = 0; i < snapshot_.positions.size(); ++i) {
    const double r = glm::distance(glm::dvec3(snapshot_.positions[i]), at);
    if (snapshot_.fluid_index[i] == kRetired || !(r < h)) continue;
    const double weight = smoothed(r, h, volume);
    sum += weight * static_cast<double>(pressures_[i]);
    weights += weight;
  }
  return weights >= kInFluid ? sum / weights : std::numeric_limits<double>::quiet_NaN();
}

const Measurement& Instruments::measure(const World& world) {
  world.fill(snapshot_);
  result_.time = snapshot_.rigid.time;
  result_.fluid = world.diagnostics();
  result_.in_body.assign(snapshot_.rigid.bodies.size(), 0);
  inside_.assign(snapshot_.positions.size(), 0);
  for (const Solid& body : bodies_) {
    find_inside(body, kInSolid * spacing_, [&](std::size_t i) {
      result_.in_body[static_cast<std::size_t>(body.body)] += 1;
      inside_[i] = 1;
    });
  }
  result_.in_solids = static_cast<std::uint64_t>(std::count(inside_.begin(), inside_.end(), 1));
  const std::size_t fluids = particle_mass_.size();
  result_.masses.assign(regions_.size(), 0.0);
  result_.fluid_masses.assign(regions_.size() * fluids, 0.0);
  in_region_.resize(regions_.size());
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    in_region_[r].clear();
    find_inside(regions_[r], 0.0, [&](std::size_t i) {
      in_region_[r].push_back(static_cast<std::uint32_t>(i));
      const std::size_t fluid = snapshot_.fluid_index[i];
      result_.masses[r] += particle_mass_[fluid];
      result_.fluid_masses[r * fluids + fluid] += particle_mass_[fluid];
    });
  }
  result_.levels.clear();
  result_.pressures.clear();
  if (!gauges_.empty()) world.fill_pressures(pressures_);
  for (const Gauge& gauge : gauges_) {
    const glm::dvec3 at =
        gauge.body < 0 ? gauge.position
                       : transform_point(snapshot_.rigid.bodies[static_cast<std::size_t>(gauge.body)].pose,
                                         gauge.position);
    result_.levels.push_back(fluid_level(snapshot_, at, up_, spacing_));
    result_.pressures.push_back(pressure(at));
  }
  return result_;
}

}  // namespace slosh
