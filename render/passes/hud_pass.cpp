#include "render/passes/hud_pass.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>

#include "render/hud_scale.h"

namespace slosh {
namespace {

/// Debian's fonts-dejavu-core; where it is not installed, Dear ImGui's own font is made larger.
constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf";
constexpr int kMinPixels = 13;
constexpr int kMaxPixels = 96;
std::atomic<float> hud_scale{1.0f};

}  // namespace

int hud_font_pixels(float picture_height) {
  return std::clamp(static_cast<int>(std::lround(0.0195f * picture_height)), kMinPixels, kMaxPixels);
}

void set_hud_scale(float scale) {
  hud_scale.store(scale, std::memory_order_relaxed);
}

Result<std::unique_ptr<HudPass>> HudPass::create(Context& context) {
  std::unique_ptr<HudPass> pass(new HudPass(context));
  ImGuiContext* before = ImGui::GetCurrentContext();
  pass->imgui_ = ImGui::CreateContext();
  ImGui::SetCurrentContext(pass->imgui_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // no file of ours appears in the user's folder
  io.LogFilename = nullptr;
  ImGui::StyleColorsDark();
  ImGui::GetStyle().WindowRounding = 4.0f;
  ImGui::GetStyle().Colors[ImGuiCol_WindowBg].w = 0.72f;
  if (auto* window = static_cast<GLFWwindow*>(context.native_window())) {
    pass->has_window_ = ImGui_ImplGlfw_InitForOpenGL(window, true);
  }
  pass->gl_ready_ = ImGui_ImplOpenGL3_Init("#version 450 core");
  if (before) ImGui::SetCurrentContext(before);
  if (!pass->gl_ready_)
    return Error{"HUD", "Dear ImGui cannot start its OpenGL backend", "Update the graphics driver"};
  return pass;
}

HudPass::~HudPass() {
  ImGuiContext* before = ImGui::GetCurrentContext();
  ImGui::SetCurrentContext(imgui_);
  if (gl_ready_) ImGui_ImplOpenGL3_Shutdown();
  if (has_window_) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext(imgui_);
  ImGui::SetCurrentContext(before == imgui_ ? nullptr : before);
}

void HudPass::fit_font() {
  ImGuiIO& io = ImGui::GetIO();
  const float scale = io.DisplayFramebufferScale.y > 0.0f ? io.DisplayFramebufferScale.y : 1.0f;
  const float wanted = hud_scale.load(std::memory_order_relaxed);
  const int fitting = hud_font_pixels(io.DisplaySize.y * scale);
  const int pixels =
      std::min(static_cast<int>(std::lround(wanted * static_cast<float>(fitting))), kMaxPixels);
  io.FontGlobalScale = 1.0f / scale;
  if (pixels == font_pixels_) return;
  font_pixels_ = pixels;
  io.Fonts->Clear();
  if (!std::filesystem::exists(kFont) || !io.Fonts->AddFontFromFileTTF(kFont, static_cast<float>(pixels))) {
    ImFontConfig own;
    own.SizePixels = static_cast<float>(pixels);
    io.Fonts->AddFontDefault(&own);
  }
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void HudPass::draw(const std::function<void()>& hud, const gl::Framebuffer& target, glm::ivec2 size) {
  ImGui::SetCurrentContext(imgui_);
  ImGuiIO& io = ImGui::GetIO();
  ImGui_ImplOpenGL3_NewFrame();
  if (has_window_) {
    ImGui_ImplGlfw_NewFrame();
    // Its backend asks where the pointer is now, and would press there.
    if (const auto at = context_.pressed_at())
      io.MousePos = ImVec2(static_cast<float>(at->x), static_cast<float>(at->y));
    // The picture is stretched to the window, and the HUD with it.
    if (io.DisplaySize.x > 0.0f && io.DisplaySize.y > 0.0f) {
      io.DisplayFramebufferScale = ImVec2(static_cast<float>(size.x) / io.DisplaySize.x,
                                          static_cast<float>(size.y) / io.DisplaySize.y);
    }
  } else {
    io.DisplaySize = ImVec2(static_cast<float>(size.x), static_cast<float>(size.y));
    io.DeltaTime = 1.0f / 60.0f;
  }
  fit_font();
  ImGui::NewFrame();
  if (hud) hud();
  ImGui::Render();
  glBindFramebuffer(GL_FRAMEBUFFER, target.name());
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace slosh
