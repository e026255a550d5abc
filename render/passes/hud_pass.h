// Dear ImGui over the picture.
#pragma once

#include <functional>
#include <memory>

#include "render/context.h"
#include "render/gl/objects.h"

struct ImGuiContext;

namespace slosh {

/// Height of the HUD's letters in pixels: a share of the picture's, so that they are read on any display.
int hud_font_pixels(float picture_height);

/// Owns one Dear ImGui context. It stays the current one after draw, so that code outside may ask it things.
class HudPass {
 public:
  /// `context` lives as long as the pass.
  static Result<std::unique_ptr<HudPass>> create(Context& context);
  ~HudPass();
  HudPass(const HudPass&) = delete;
  HudPass& operator=(const HudPass&) = delete;

  /// Runs `hud` between NewFrame and Render; blends into `target` of `size` pixels.
  void draw(const std::function<void()>& hud, const gl::Framebuffer& target, glm::ivec2 size);

 private:
  explicit HudPass(Context& context) : context_(context) {}
  void fit_font();
  Context& context_;
  ImGuiContext* imgui_ = nullptr;
  int font_pixels_ = 0;  ///< that the font's atlas was made for
  bool has_window_ = false;
  bool gl_ready_ = false;
};

}  // namespace slosh
