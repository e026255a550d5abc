// What the instruments of a run read, for summary.json and in words.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace slosh {

struct MeasuredBody {
  std::string name;
  glm::dvec3 position{0.0};        ///< m, of the mesh frame, at the end
  glm::dvec3 mean_force{0.0};      ///< N, of the fluid, over the run
  glm::dvec3 mean_torque{0.0};     ///< N·m, about the centre of mass, over the run
  double peak_force = 0.0;         ///< N, of the rows
  std::uint64_t fluid_inside = 0;  ///< particles, at the end
};

/// A gauge's level (m) or a region's mass (kg).
struct MeasuredPlace {
  std::string name;
  double start = 0.0, end = 0.0, least = 0.0, most = 0.0;  ///< NaN where a gauge had no fluid
};

struct MeasuredRun {
  double interval = 0.0;  ///< simulated s between rows; 0 = nothing was measured
  std::vector<MeasuredBody> bodies;
  std::vector<MeasuredPlace> levels;
  std::vector<MeasuredPlace> masses;
  // The fluid at the end:
  glm::dvec3 center{0.0};       ///< m
  glm::dvec3 momentum{0.0};     ///< kg·m/s
  double kinetic_energy = 0.0;  ///< J
};

nlohmann::ordered_json to_json(const MeasuredRun& run);
/// A line for each body and place, empty where nothing was measured.
std::string in_words(const MeasuredRun& run);

}  // namespace slosh
