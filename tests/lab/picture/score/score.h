// How far a drawn surface is from the right one, and how much a picture changes that should not. Plain maths.
#pragma once

#include <array>

#include "render/image.h"
#include "tests/lab/picture/score/pool.h"

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

/// How far a picture is from the right one where there is fluid: a mean over the whole picture is mostly of
/// what no surface changes.
struct PictureScore {
  double inside = 0.0;  ///< mean difference of a channel, of 255, over fluid away from its edges
  double edges = 0.0;   ///< the same within kEdgeBand of them, outside of the fluid too
  std::size_t inside_pixels = 0;
  std::size_t edge_pixels = 0;
};

/// `depth`: of the fluid, one for all pictures that are compared (Buffer::kFrontDepth of one of them);
/// `jump`: difference in depth that is an edge, m. Pictures and depth of one size.
PictureScore score_picture(const Image& drawn, const Image& right, const FloatImage& depth, float jump);

/// Mean change of a channel of a pixel, of 255. Pictures of one size.
double flicker(const Image& a, const Image& b);

/// What three pictures, evenly apart in time, show of the fluid's motion, over the pixels where all three
/// show fluid: mean change of a channel, of 255, as sRGB shows it.
struct StirScore {
  double change = 0.0;  ///< from one picture to the next: what moves, too
  /// Of the middle one from the mean of the others: what goes back and forth. What changes evenly adds
  /// nothing, what flickers from picture to picture counts as it does for `change`.
  double restless = 0.0;
  std::size_t pixels = 0;
};

/// `light`: scene-linear, three channels (Buffer::kFinalColor); `index`: Buffer::kFluidIndex. Of one size.
StirScore score_stir(const std::array<FloatImage, 3>& light, const std::array<FloatImage, 3>& index);

}  // namespace slosh::score
