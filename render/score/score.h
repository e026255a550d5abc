// How far a drawn surface is from the right one, and how much a picture changes that should not. Plain maths.
#pragma once

#include "render/image.h"
#include "render/score/pool.h"

namespace slosh::score {

/// Pixels from a jump in the exact depth, or from the fluid's end, within which a pixel counts as edge.
inline constexpr int kEdgeBand = 8;

struct SurfaceScore {
  double normal_mean = 0.0;  ///< degrees between drawn and exact normal, away from edges
  double normal_p95 = 0.0;
  double edge_mean = 0.0;  ///< the same in the band along edges
  double depth_bias =
      0.0;  ///< drawn less exact depth, particle radii, mean away from edges; below 0 = too near
  double depth_rms = 0.0;  ///< about that mean
  double silhouette =
      0.0;  ///< pixels between drawn and exact outline, mean: area between them over its length
  std::size_t pixels = 0;  ///< that normal_mean is over
};

/// Depth and normal as Renderer::read_buffer gives them (kSmoothDepth, kNormal). `jump`: difference in depth
/// that is an edge, m.
SurfaceScore score_surface(const FloatImage& depth, const FloatImage& normal, const Exact& exact,
                           float particle_radius, float jump);

/// Mean change of a channel of a pixel, of 255. Pictures of one size.
double flicker(const Image& a, const Image& b);

}  // namespace slosh::score
