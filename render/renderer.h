// Frame → image: the paper's section 5 in OpenGL 4.5. README.md lists the passes. No GL types here.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/context.h"
#include "render/environment.h"
#include "render/frame.h"
#include "render/image.h"
#include "sim/math/result.h"

namespace slosh {

/// From scene-linear light to the screen.
enum class Display : std::uint8_t {
  kAces,  ///< ACES SDR video output transform, sRGB display (OpenColorIO)
  kSrgb,  ///< clip to 0–1 and encode as sRGB: a colour below 1 stays what it is
};

/// How a shader gets there.
enum class DisplayBy : std::uint8_t {
  kSmaller,  ///< OpenColorIO's own text where that needs no textures and is short, else the table
  kTable,    ///< a baked table of 40³ colours: within 4/255, light up to 32 times white
  kText,     ///< that text wherever it needs no textures: exact
};

/// A user's OpenColorIO configuration in place of Display.
struct ColorConfig {
  std::string file;     ///< an .ocio file; empty: none
  std::string display;  ///< by name; empty: the config's own first
  std::string view;     ///< by name; empty: the display's own first
  bool operator==(const ColorConfig&) const = default;
};

/// How much is spent on looks where the paper leaves it open.
enum class Quality : std::uint8_t {
  kAuto,  ///< kFast where a CPU draws (llvmpipe), else kFull
  kFast,  ///< a third of the shadow taps, shadow map of 3/4 the size, no occlusion of meshes, only the
          ///< sides of glass that face the eye and are before the fluid
  kFull,  ///< with all of these, and the bodies mirrored in the fluid
};

/// How the splats' depths become the fluid's surface.
enum class Surface : std::uint8_t {
  kPaper,          ///< section 5 as it stands: its filter, and Eq 15 with its T
  kCurvatureFlow,  ///< van der Laan, Green & Sainz 2009, the paper's [21]: 60 steps
  kOurs,           ///< centres smoothed (Yu & Turk 2013), narrow-range filter (Truong & Yuksel 2018)
};

/// Which of the two paths draws: a stage has one for GPUs and one for processors.
enum class PixelPasses : std::uint8_t {
  kOfMachine,  ///< kFragments where a CPU draws (llvmpipe), else kCompute
  kFragments,  ///< fragments, and the CPU itself where it is quicker than its fragments
  kCompute,    ///< compute shaders, particles on the GPU. The picture is the same to rounding
};

struct RenderOptions {
  int width = 960;  ///< pixels of the picture, 1–16384
  int height = 540;

  Surface surface = Surface::kOurs;
  int bilateral_iterations = 4;  ///< of section 5.1's filter, 0–64; 0 = no filter, whatever the surface
  float bilateral_range =
      6.0f;                  ///< difference in depth at which the filter's weight is 0, particle radii, > 0
  float splat_scale = 1.2f;  ///< splat radius over particle radius (5.1), > 0
  bool half_resolution_back = true;  ///< back depth at half the picture's size (5.1)

  bool fresnel = true;  ///< beyond the paper: Schlick reflection of the surroundings, F0 0.02
  bool lit_fluid =
      true;  ///< beyond the paper: light off and out of the fluid as its look says, in place of Eq 15
  bool body_reflections = true;  ///< beyond the paper: the fluid mirrors the bodies, too, as far as the
                                 ///< picture shows them (kFull); needs fresnel and lit_fluid
  bool caustics = false;  ///< beyond the paper: the fluid's surface focuses the light on what lies below, as
                          ///< far as the picture shows both (kFull); needs lit_fluid and shadow_size > 0
  bool layers = true;   ///< beyond the paper: layers of fluid with air between count each by itself; not with
                        ///< Surface::kPaper
  bool bridges = true;  ///< beyond the paper: gaps between few particles are closed (passes/bridges.h); where
                        ///< a CPU draws, with Surface::kOurs

  bool soft_mixing =
      true;  ///< beyond the paper: where fluids meet, their looks go over into each other within some four
             ///< particles; needs lit_fluid. Costs nothing where all that is seen is one fluid

  int shadow_size = 1024;         ///< texels a side of the light's shadow map, 0 = no shadows, up to 8192
  bool ambient_occlusion = true;  ///< darken creases of the meshes (kFull)
  bool fluid_shadow = true;  ///< beyond the paper: fluid dims the light that passes it; needs shadow_size > 0
  bool antialias = true;     ///< beyond the paper: smooth edges in the picture as shown (not in its buffers)
  bool keep_still = true;    ///< where a CPU draws with antialias: what cannot have changed since the picture
                             ///< before is kept while the eye stands still
  bool draw_background = true;  ///< false: black behind everything
  Quality quality = Quality::kAuto;
  PixelPasses pixel_passes = PixelPasses::kOfMachine;
  Display display = Display::kAces;
  DisplayBy display_by = DisplayBy::kSmaller;
  ColorConfig color;  ///< goes before `display` where it names a file
  bool dither =
      true;  ///< beyond the paper: less than a step of eight bits, so that soft shades show no bands
  std::shared_ptr<const Environment>
      environment;        ///< what is far away, in place of our studio's formula (environment.h)
  float exposure = 1.0f;  ///< factor on scene-linear light before the display transform, > 0
};

/// `options` with all of section 5 and nothing beyond it: its filter four times, half-size back depth, Eq 15.
RenderOptions section_five(RenderOptions options);

/// Milliseconds of one pass of the last frame, when timing is on.
struct PassTime {
  std::string pass;
  double milliseconds = 0.0;
  double cpu_milliseconds = 0.0;  ///< of which the caller's thread was busy with it, or waited
};

/// What tests may look at. Depths are linear eye depths in m; kNoFluidDepth or more = no fluid here.
enum class Buffer : std::uint8_t {
  kSceneDepth,   ///< S_d; beyond the far plane where there is no mesh
  kSceneColor,   ///< S_c, three channels, scene-linear, before the fluid
  kFinalColor,   ///< three channels, scene-linear, after the fluid, the translucent meshes and the arrows
  kFrontDepth,   ///< F_fD before the filter
  kSmoothDepth,  ///< F_fD after the filter
  kBackDepth,    ///< F_bD, at half size if so asked; 0 where there is no fluid
  kThickness,    ///< T of Eq 15, m; 0 = no fluid seen
  kFluidIndex,   ///< the front-most particle's index into Frame::fluids, −1 = none
  kCaustics,  ///< at half size: light that comes through the surface over that through a level one; 1: none
  kNormal,    ///< three channels, unit, eye axes; 0 where no fluid is drawn
};

inline constexpr float kNoFluidDepth = 1.0e6f;

/// Where a picture goes beside the renderer's own: a 2-D texture of this context, of four 8-bit channels
/// (GL_RGBA8 or GL_SRGB8_ALPHA8: the bytes are sRGB either way) and of the picture's size; the bottom row is
/// first.
struct PictureTarget {
  std::uint32_t texture = 0;  ///< GL name; 0 = nowhere else
};

/// Draws frames with one context. All calls on the thread the context is current on. The context must outlive
/// it.
class Renderer : public MeshSink {
 public:
  /// Errors: sizes or factors out of range, a shader that the driver refuses, no display transform.
  static Result<std::unique_ptr<Renderer>> create(Context& context, const RenderOptions& options = {});
  ~Renderer() override;
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// To the GPU.
  MeshHandle add_mesh(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                      std::span<const glm::uvec3> triangles,
                      std::span<const glm::vec2> texcoords = {}) override;
  void remove_mesh(MeshHandle mesh) override;
  TextureHandle add_texture(const TextureImage& image) override;

  /// What all pictures of a moment share, once: shadows that reach all of `views` (Frame::view is passed
  /// over; without any nothing is shadowed), the fluids' looks. The frame is kept, so what it points to must
  /// live until the last draw(). Unknown mesh handles, non-finite particles and arrows, and particles whose
  /// fluid is not in Frame::fluids are left out.
  void prepare(const Frame& frame, std::span<const View> views);
  /// One picture of what was prepared, without a HUD: into the renderer's own, which read_back() reads, and
  /// from there to `target` as the bytes are.
  void draw(const View& view, const PictureTarget& target = {});
  /// Two pictures of it, as both eyes have them, each the same as by itself: side by side where compute
  /// shaders draw, which takes less time than one after the other. More than two are left out.
  void draw(std::span<const View> views, std::span<const PictureTarget> targets = {});
  /// From now on draw_hud() stretches the picture to `size` pixels before the HUD goes over it, so that the
  /// HUD's letters are sharp however few pixels the picture has; read_back() and present() then have that.
  /// {0, 0}: the picture as it is. Sizes are clamped to 16384.
  void stretch_to(glm::ivec2 size);
  /// Runs Frame::hud once, over the picture drawn last (of two, the first, or `view` 1).
  void draw_hud(std::size_t view = 0);
  /// Runs Frame::hud once, by itself, into `target` of `size` pixels: sRGB, transparent where nothing is,
  /// colours multiplied by alpha.
  void draw_panel(glm::ivec2 size, const PictureTarget& target);
  /// The frame is over: shows the picture drawn last in the window if the context has one (stretched to it;
  /// call Context::swap after).
  void present();

  /// All of this for one picture: of Frame::view, with the HUD over it.
  void draw(const Frame& frame);

  /// The picture drawn last, as stretched where it was; of two that were drawn together, `view` 0 or 1.
  Image read_back(std::size_t view = 0);
  FloatImage read_buffer(Buffer buffer);

  const RenderOptions& options() const;
  /// The last frame's particles were read where they lie on the GPU (Frame::on_gpu).
  bool reads_particles_on_gpu() const;
  /// Why particles that were offered there go through main memory, in words; empty where they do not, or were
  /// not.
  std::string particles_refused() const;
  /// Quality::kAuto resolved: kFast or kFull.
  Quality quality() const;
  /// What PixelPasses came to.
  bool on_compute() const;
  /// Takes effect at the next draw. Errors as create; the old options then stay.
  Result<bool> set_options(const RenderOptions& options);
  /// Changes the picture's size; out-of-range sizes are clamped.
  void resize(int width, int height);

  /// Time each pass, by the GPU's own clock or, where a CPU draws, by finishing each pass (slows drawing
  /// down); pass_times() then holds the last frame.
  void set_timing(bool on);
  const std::vector<PassTime>& pass_times() const;

 private:
  struct Parts;
  explicit Renderer(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace slosh
