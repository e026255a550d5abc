// The slow truth: a frame by path tracing, over the look functions of the quick pictures. Meshes and the
// fluid's surface are intersected by Embree; without it nothing of this can be made.
#pragma once

#include <cstdint>
#include <memory>

#include "render/environment.h"
#include "render/frame.h"
#include "render/image.h"
#include "sim/math/result.h"
#include "tests/lab/picture/score/pool.h"

namespace slosh::reference {

struct Options {
  int width = 640;  ///< pixels, 1–16384
  int height = 480;
  int samples = 64;                          ///< paths a pixel, 1–65536; the noise falls with their root
  int photons = 0;                           ///< sent from the light through fluid: caustics; 0: none
  int threads = 1;                           ///< >= 1
  const Environment* environment = nullptr;  ///< what is far away; null: our studio
  float cell = 0.6f;                         ///< of the fluid's surface, particle radii (fluid_mesh.h)
};

class PathTracer : public MeshSink {
 public:
  /// Errors: built without Embree, none installed, or it cannot start.
  static Result<std::unique_ptr<PathTracer>> create();
  /// Scene-linear Rec.709, three channels. What differs from Renderer's pictures: the fluid is one surface of
  /// triangles whose light is followed in and out (Fresnel, Snell, Beer and Lambert; a random walk where it
  /// scatters, with the single-scattering albedo that gives F_c from a deep layer: Chiang, Kutz & Burley
  /// 2016), and bodies light each other. Light comes straight through fluid to what lies in it or below,
  /// dimmed; with `photons` bodies get it as the fluids' surfaces refract and mirror it (focused_light.h),
  /// their sheen of it left out. Glass is the same thin pane. Light that has scattered leaves the fluid
  /// without being mirrored back at its surface, since F_c is what comes out. No arrows, no HUD. The same
  /// frame and options give the same picture.
  virtual FloatImage draw(const Frame& frame, const Options& options) = 0;
  /// Where fluid is the first thing that a pixel's middle sees, glass aside: what the pictures' depth and
  /// normal should be. Of `options` size and cell count.
  virtual score::Exact first_seen(const Frame& frame, const Options& options) = 0;
};

}  // namespace slosh::reference
