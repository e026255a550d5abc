// Window contexts through GLFW.
#include "render/context.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

namespace slosh {
namespace {

constexpr auto kKeyOfGlfw = std::to_array<std::pair<int, Key>>({
    {GLFW_KEY_ESCAPE, Key::kEscape},
    {GLFW_KEY_SPACE, Key::kSpace},
    {GLFW_KEY_ENTER, Key::kEnter},
    {GLFW_KEY_TAB, Key::kTab},
    {GLFW_KEY_BACKSPACE, Key::kBackspace},
    {GLFW_KEY_LEFT, Key::kLeft},
    {GLFW_KEY_RIGHT, Key::kRight},
    {GLFW_KEY_UP, Key::kUp},
    {GLFW_KEY_DOWN, Key::kDown},
    {GLFW_KEY_PAGE_UP, Key::kPageUp},
    {GLFW_KEY_PAGE_DOWN, Key::kPageDown},
    {GLFW_KEY_HOME, Key::kHome},
    {GLFW_KEY_END, Key::kEnd},
    {GLFW_KEY_LEFT_SHIFT, Key::kShift},
    {GLFW_KEY_RIGHT_SHIFT, Key::kShift},
    {GLFW_KEY_LEFT_CONTROL, Key::kControl},
    {GLFW_KEY_RIGHT_CONTROL, Key::kControl},
    {GLFW_KEY_LEFT_ALT, Key::kAlt},
    {GLFW_KEY_RIGHT_ALT, Key::kAlt},
});

/// In the order of MouseButton.
constexpr std::array kButtons{GLFW_MOUSE_BUTTON_LEFT, GLFW_MOUSE_BUTTON_RIGHT, GLFW_MOUSE_BUTTON_MIDDLE};

constexpr std::size_t index_of(Key key) {
  return static_cast<std::size_t>(key);
}

std::string last_glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "unknown reason";
}

class GlfwContext final : public Context {
 public:
  explicit GlfwContext(GLFWwindow* window) : window_(window) {
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, this);
    // The HUD's GLFW backend, made later, calls these on.
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double x, double y) {
      auto* self = static_cast<GlfwContext*>(glfwGetWindowUserPointer(w));
      self->scroll_ += glm::vec2(x, y);
    });
    // GLFW knows where the pointer is, not where it was when a button went down.
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
      static_cast<GlfwContext*>(glfwGetWindowUserPointer(w))->pointer_ = {x, y};
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
      if (action == GLFW_PRESS) static_cast<GlfwContext*>(glfwGetWindowUserPointer(w))->take_press(button);
    });
    glfwGetCursorPos(window_, &pointer_.x, &pointer_.y);
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int) {
      static_cast<GlfwContext*>(glfwGetWindowUserPointer(w))->take_key(key, action);
    });
    // A window that is moved under a pointer that stands still is no movement of the mouse.
    glfwSetWindowPosCallback(window_, [](GLFWwindow* w, int, int) {
      static_cast<GlfwContext*>(glfwGetWindowUserPointer(w))->mouse_known_ = false;
    });
    describe_current();
  }
  ~GlfwContext() override { glfwDestroyWindow(window_); }

  void make_current() override { glfwMakeContextCurrent(window_); }
  void release_current() override { glfwMakeContextCurrent(nullptr); }
  bool has_window() const override { return true; }
  glm::ivec2 framebuffer_size() const override {
    glm::ivec2 size(0);
    glfwGetFramebufferSize(window_, &size.x, &size.y);
    return size;
  }
  bool should_close() const override { return glfwWindowShouldClose(window_) == GLFW_TRUE; }
  void swap() override { glfwSwapBuffers(window_); }
  void follow_screen(bool wait) override { glfwSwapInterval(wait ? 1 : 0); }
  void* native_window() const override { return window_; }
  std::optional<glm::dvec2> pressed_at() const override { return pressed_at_; }

  const InputState& poll() override {
    scroll_ = glm::vec2(0.0f);
    input_.presses.clear();
    pressed_at_.reset();
    pressed_.fill(false);
    glfwPollEvents();
    input_.scroll = scroll_;
    take_mouse();
    if (ImGui::GetCurrentContext()) {
      input_.hud_wants_mouse = ImGui::GetIO().WantCaptureMouse;
      // Not WantCaptureKeyboard: that is any slider under the mouse, and takes keys that are nobody's.
      input_.hud_wants_keyboard = ImGui::GetIO().WantTextInput;
    }
    return input_;
  }

 private:
  void take_mouse() {
    glm::dvec2 pointer(0.0);
    glfwGetCursorPos(window_, &pointer.x, &pointer.y);
    // A drag begins where its button went down; what the pointer went since is of the next poll.
    pointer = pressed_at_.value_or(pointer);
    glm::ivec2 window_size(1);
    glfwGetWindowSize(window_, &window_size.x, &window_size.y);
    const glm::vec2 scale = glm::vec2(framebuffer_size()) / glm::vec2(glm::max(window_size, glm::ivec2(1)));
    const glm::vec2 mouse = glm::vec2(pointer) * scale;
    // Where the pointer goes outside (to another window, and back in elsewhere) is no business of ours,
    // unless it was dragged there.
    const bool dragging = std::any_of(input_.buttons.begin(), input_.buttons.end(), [](bool b) { return b; });
    const bool here = dragging || glfwGetWindowAttrib(window_, GLFW_HOVERED) == GLFW_TRUE;
    input_.mouse_delta = mouse_known_ && here ? mouse - input_.mouse : glm::vec2(0.0f);
    input_.mouse = mouse;
    mouse_known_ = here;
    // One that was let go in the same poll, too: a click on a slow picture.
    for (std::size_t i = 0; i < kButtons.size(); ++i)
      input_.buttons[i] = pressed_[i] || glfwGetMouseButton(window_, kButtons[i]) == GLFW_PRESS;
  }

  void take_press(int glfw_button) {
    if (!pressed_at_) pressed_at_ = pointer_;
    for (std::size_t i = 0; i < kButtons.size(); ++i) pressed_[i] |= kButtons[i] == glfw_button;
  }

  void take_key(int glfw_key, int action) {
    if (action == GLFW_REPEAT) return;
    Key key = Key::kCount;
    if (glfw_key >= GLFW_KEY_A && glfw_key <= GLFW_KEY_Z) {
      key = static_cast<Key>(index_of(Key::kA) + static_cast<std::size_t>(glfw_key - GLFW_KEY_A));
    } else if (glfw_key >= GLFW_KEY_0 && glfw_key <= GLFW_KEY_9) {
      key = static_cast<Key>(index_of(Key::k0) + static_cast<std::size_t>(glfw_key - GLFW_KEY_0));
    } else if (glfw_key >= GLFW_KEY_F1 && glfw_key <= GLFW_KEY_F12) {
      key = static_cast<Key>(index_of(Key::kF1) + static_cast<std::size_t>(glfw_key - GLFW_KEY_F1));
    } else {
      for (const auto& [code, named] : kKeyOfGlfw) {
        if (code == glfw_key) key = named;
      }
    }
    if (key == Key::kCount) return;
    input_.keys[index_of(key)] = action == GLFW_PRESS;
    if (action == GLFW_PRESS) input_.presses.push_back({key, input_.held(Key::kShift)});
  }

  GLFWwindow* window_;
  InputState input_;
  glm::vec2 scroll_{0.0f};
  glm::dvec2 pointer_{0.0};                      // of the newest event
  std::optional<glm::dvec2> pressed_at_;         // in the last poll, the first press
  std::array<bool, kButtons.size()> pressed_{};  // in the last poll
  bool mouse_known_ = false;
};

}  // namespace

Result<std::unique_ptr<Context>> make_window_context(const std::string& title, int width, int height) {
  if (width < 1 || height < 1 || width > 16384 || height > 16384) {
    return Error{"window", std::to_string(width) + " × " + std::to_string(height) + " is no window size",
                 "Use 1 to 16384 a side"};
  }
  if (!display_available()) {
    return Error{"window", "there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set)",
                 "Run on a desktop, or without a window"};
  }
  // Initialising twice does nothing. It is never terminated: the libraries of X11 that GLFW loads leak when
  // unloaded.
  if (glfwInit() != GLFW_TRUE) {
    return Error{"window", "the display cannot be reached: " + last_glfw_error(),
                 "Check DISPLAY, or run without a window"};
  }
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  GLFWwindow* window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (!window) {
    return Error{"window", "OpenGL 4.5 core is not to be had: " + last_glfw_error(),
                 "Update the graphics driver, or run without a window"};
  }
  return std::unique_ptr<Context>(new GlfwContext(window));
}

}  // namespace slosh
