// The boundary particle layer of a wall, and what each of its particles stands for.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "sim/math/pose.h"
#include "sim/plan.h"

namespace slosh {

/// One particle of that layer.
struct LayerParticle {
  glm::vec3 position{0.0f};  ///< m
  glm::vec3 surface{0.0f};   ///< m, where on the mesh it belongs
  glm::vec3 normal{0.0f};    ///< unit, out of the solid there; 0: it fills an edge or is a very thin wall's,
                             ///< and belongs to no face
  float depth = 0.0f;        ///< m, how far behind the surface it is to count as lying
  float lacks = 0.0f;  ///< m, by how much it lies less deep, in the middle of a wall of less than two depths
};

/// The same in another frame.
LayerParticle moved(const Pose& pose, const LayerParticle& p);

/// How many lattice particles each of a layer stands for, one by one (after Akinci 2012's volume correction):
/// kWallShare on a flat layer at the spacing. Where layers crowd or cross (corners) the particles share what
/// one layer would be; the two sides of a thin wall share by what each adds to the density where fluid is to
/// stand.
std::vector<float> layer_shares(std::span<const LayerParticle> layer, const Plan& plan);

}  // namespace slosh
