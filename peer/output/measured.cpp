#include "peer/output/measured.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "sim/math/format.h"

namespace slosh {
namespace {

using Json = nlohmann::ordered_json;

Json vector(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// JSON has no NaN.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json places(const std::vector<MeasuredPlace>& all) {
  Json json = Json::array();
  for (const MeasuredPlace& place : all) {
    json.push_back({{"name", place.name},
                    {"start", number(place.start)},
                    {"end", number(place.end)},
                    {"least", number(place.least)},
                    {"most", number(place.most)}});
  }
  return json;
}

}  // namespace

Json to_json(const MeasuredRun& run) {
  Json bodies = Json::array();
  for (const MeasuredBody& body : run.bodies) {
    bodies.push_back({{"name", body.name},
                      {"position_m", vector(body.position)},
                      {"mean_force_n", vector(body.mean_force)},
                      {"mean_torque_nm", vector(body.mean_torque)},
                      {"peak_force_n", body.peak_force},
                      {"fluid_inside", body.fluid_inside}});
  }
  return {{"interval_s", run.interval},
          {"bodies", bodies},
          {"levels_m", places(run.levels)},
          {"masses_kg", places(run.masses)},
          {"fluid",
           {{"center_m", vector(run.center)},
            {"momentum_kg_m_s", vector(run.momentum)},
            {"kinetic_energy_j", run.kinetic_energy}}}};
}

std::string in_words(const MeasuredRun& run) {
  std::string text;
  for (const MeasuredBody& body : run.bodies) {
    text +=
        format("%s: the fluid's force was (%.4g, %.4g, %.4g) N in the mean, at most %.4g N.\n",
               body.name.c_str(), body.mean_force.x, body.mean_force.y, body.mean_force.z, body.peak_force);
  }
  for (const MeasuredPlace& level : run.levels) {
    text += std::isfinite(level.end) ? format("%s: level %.4f m at the end (%.4f to %.4f).\n",
                                              level.name.c_str(), level.end, level.least, level.most)
                                     : format("%s: no fluid at the end.\n", level.name.c_str());
  }
  for (const MeasuredPlace& mass : run.masses) {
    text += format("%s: %.4g kg of fluid at the end, %.4g at the start.\n", mass.name.c_str(), mass.end,
                   mass.start);
  }
  return text;
}

}  // namespace slosh
