// What is where nothing can act on it.
#include <algorithm>
#include <cmath>

#include "scenes/inspection/around.h"
#include "scenes/inspection/inspection.h"
#include "scenes/reading/reading.h"
#include "sim/math/format.h"
#include "sim/math/limits.h"

namespace slosh::inspection {
namespace {

constexpr double kOverNothing = 0.5;    // share of a fluid that sees a body below
constexpr double kCoarsePlaces = 1e-3;  // of a spacing: floats that are farther apart than this
constexpr double kLargestHeld = 2.5;    // m: more than a person's reach
constexpr double kLightest = 1.0;       // kg/m³ of a body that a hand holds: air

std::string place_text(const glm::dvec3& place) {
  const glm::dvec3 p = in_blender(place);
  return format("(%.4g, %.4g, %.4g) m in Blender's world, z up", p.x + 0.0, p.y + 0.0, p.z + 0.0);
}

void look_at_hands(const gltf::Document& document, const Scene& scene, std::vector<Finding>& warnings) {
  for (const Grip& grip : scene.grips) {
    const std::string where = document.file + ": the hand of grip '" + grip.name + "'";
    const auto& keys = grip.hand_motion;
    const auto out = std::ranges::find_if(keys, [&](const PoseKey& key) {
      const glm::dvec3& p = key.pose.position;
      return glm::any(glm::lessThan(p, lowest_handle(scene.domain_min))) ||
             glm::any(glm::greaterThan(p, highest_handle(scene.domain_max)));
    });
    if (out != keys.end())
      warnings.push_back(
          {"hand-out-of-reach",
           {where,
            format("is at %.3g s more than %.3g m outside the scene's domain, at ", out->time, kHandleReach) +
                place_text(out->pose.position) + ": it is not accepted there, and holds where it was last",
            "Keep it nearer, or widen the scene's domain_min_m and domain_max_m"}});
    const auto fast = std::adjacent_find(keys.begin(), keys.end(), [](const PoseKey& a, const PoseKey& b) {
      return glm::distance(a.pose.position, b.pose.position) > kHandleSpeed * (b.time - a.time);
    });
    if (fast != keys.end())
      warnings.push_back(
          {"hand-too-fast",
           {where,
            format("moves at %.3g m/s at %.3g s, and hands faster than %.3g m/s are not accepted",
                   glm::distance(fast->pose.position, (fast + 1)->pose.position) /
                       ((fast + 1)->time - fast->time),
                   fast->time, kHandleSpeed),
            "Give its keys more time between them"}});
  }
}

void look_at_vessels(const gltf::Document& document, const Scene& scene, std::vector<Finding>& warnings) {
  const double g = glm::length(scene.gravity);
  if (!(g > 0.0)) return;
  const Around around(scene);
  for (const FluidVolume& volume : scene.fluid_volumes) {
    const double held = around.closed(volume, scene.gravity / g);
    if (held >= kOverNothing) continue;
    warnings.push_back(
        {"no-vessel",
         {document.file + ": node '" + volume.name + "'",
          format("lies in no vessel: %.0f %% of the fluid has nothing below it and falls out of the scene",
                 100.0 * (1.0 - held)),
          "Put a body with a floor under it (slosh = \"body\")"}});
  }
}

void look_at_places(const gltf::Document& document, const Scene& scene, std::vector<Finding>& warnings) {
  const reading::Bounds bounds = reading::bounds_of_scene(scene);
  const glm::dvec3 far = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
  const double most = std::max({far.x, far.y, far.z});
  const double apart = std::ldexp(1.0, std::ilogb(std::max(most, 1e-3)) - 23);
  const double spacing = scene.spacing > 0.0 ? scene.spacing : scene.spacing_max;
  if (apart <= kCoarsePlaces * spacing) return;
  warnings.push_back(
      {"far-away",
       {document.file,
        format(
            "is %.4g m from its origin: places there are %.2g mm apart, too coarse for particles of %.3g mm",
            most, 1e3 * apart, 1e3 * spacing),
        "Move everything near the origin: in Blender select all and move it (G)"}});
}

glm::dvec3 size_of(const Scene& scene, const Body& body) {
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const glm::vec3& p : scene.meshes[static_cast<std::size_t>(body.mesh)].positions) {
    low = glm::min(low, glm::dvec3(p));
    high = glm::max(high, glm::dvec3(p));
  }
  return high - low;
}

/// What a hand holds is of a hand's size and weighs more than air: else its file counts in another unit.
void look_at_units(const gltf::Document& document, const Scene& scene, std::vector<Finding>& warnings) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    const bool held =
        std::ranges::any_of(scene.grips, [&](const Grip& grip) { return grip.body == static_cast<int>(b); });
    if (body.point_probe || !held) continue;
    const glm::dvec3 size = size_of(scene, body);
    const double largest = std::max({size.x, size.y, size.z});
    const double around = body.mass.mass / std::max(size.x * size.y * size.z, 1e-30);
    const std::string where = document.file + ": node '" + body.name + "'";
    const std::string measures = format("is %.3g m large, and a hand holds it", largest);
    if (largest > kLargestHeld) {
      const char* const unit = largest > 20.0  ? "millimetres"
                               : largest > 8.0 ? "centimetres"
                                               : "feet or inches";
      warnings.push_back({"units",
                          {where, measures + ": does the file count in " + unit + "?",
                           "In Blender: Scene Properties > Units, Metric and Unit Scale 1, scale everything, "
                           "then Object > Apply > Scale; sizes are in metres (a mug is 0.1)"}});
    } else if (largest < 0.002) {
      warnings.push_back({"units",
                          {where, measures + ": was it scaled down, or are its sizes in kilometres?",
                           "Sizes are in metres (a mug is 0.1)"}});
    } else if (around < kLightest) {
      warnings.push_back({"units",
                          {where,
                           format("weighs %.3g kg and fills a box of %.3g litres, less than air does",
                                  body.mass.mass, 1e3 * size.x * size.y * size.z),
                           "Sizes are in metres and weights in kg: look at both"}});
    }
  }
}

}  // namespace

void look_at_reach(const gltf::Document& document, const Scene& scene, std::vector<Finding>& warnings) {
  look_at_hands(document, scene, warnings);
  look_at_vessels(document, scene, warnings);
  look_at_places(document, scene, warnings);
  look_at_units(document, scene, warnings);
}

}  // namespace slosh::inspection
