// Dear ImGui over the picture.
#pragma once

#include <functional>
#include <memory>

#include "render/context.h"
#include "render/passes/targets.h"

struct ImGuiContext;

namespace slosh {

/// Owns one Dear ImGui context. It stays the current one after draw, so that code outside may ask it things.
class HudPass {
 public:
  static Result<std::unique_ptr<HudPass>> create(Context& context);
  ~HudPass();
  HudPass(const HudPass&) = delete;
  HudPass& operator=(const HudPass&) = delete;

  /// Runs `hud` between NewFrame and Render; blends into display.
  void draw(const std::function<void()>& hud, const Targets& targets);

 private:
  HudPass() = default;
  ImGuiContext* imgui_ = nullptr;
  bool has_window_ = false;
  bool gl_ready_ = false;
};

}  // namespace slosh
