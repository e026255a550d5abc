// Where OpenGL 4.5 comes from: a window, or no display at all. No GL or GLFW types here.
//
// A context is made current on the thread that makes it. Everything of one context (poll, swap, its Renderer)
// stays on that thread, unless it is handed over with release_current() and make_current(). GLFW keeps
// process-wide state: all window contexts must be made, polled and destroyed on one thread.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>

#include "render/input.h"
#include "sim/math/result.h"

namespace slosh {

/// An OpenGL 4.5 core context.
class Context {
 public:
  virtual ~Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  virtual void make_current() = 0;
  virtual void release_current() = 0;

  virtual bool has_window() const = 0;
  /// Pixels of the window's framebuffer, (0, 0) while minimised or without a window.
  virtual glm::ivec2 framebuffer_size() const = 0;
  /// Takes in the window's events and returns the state after them. Does nothing without a window.
  virtual const InputState& poll() = 0;
  /// The user asked for the window to be closed.
  virtual bool should_close() const = 0;
  /// Shows what was drawn. Does nothing without a window.
  virtual void swap() = 0;
  /// Whether swap() waits for the screen (as it does at first), or something else sets the pace. Does nothing
  /// without a window.
  virtual void follow_screen(bool wait) { (void)wait; }

  /// The GL renderer and version, e.g. "llvmpipe (LLVM 15.0.6, 256 bits), 4.5 (Core Profile) Mesa 22.3.6".
  const std::string& description() const { return description_; }
  /// True where a CPU draws (llvmpipe, softpipe, swrast).
  bool is_software() const { return is_software_; }

  /// Where a button went down in the last poll, in the window's coordinates; nothing where none did.
  virtual std::optional<glm::dvec2> pressed_at() const { return std::nullopt; }

  /// The GLFWwindow behind it, for this room's HUD; null without a window.
  virtual void* native_window() const { return nullptr; }

 protected:
  Context() = default;
  /// Fills the description and routes GL's debug output to the log. The context must be current.
  void describe_current();

 private:
  std::string description_;
  bool is_software_ = false;
};

struct HeadlessOptions {
  /// Threads that llvmpipe draws with; 0 leaves the choice to it. It reads this (environment LP_NUM_THREADS)
  /// once per process, so only the first headless context's wish counts. No effect on a GPU. Where other
  /// threads may read the environment, call set_software_threads() with the same number before they start.
  int software_threads = 0;
  /// The GPU to draw on, from 0 as CUDA counts; where EGL does not tell that, in EGL's order. Below 0: the
  /// first that gives OpenGL 4.5, else a software renderer.
  int gpu = -1;
  /// Ask the driver for its debug output; slower on some GPUs.
  bool debug = false;
};

/// Writes the wish of HeadlessOptions::software_threads (1–64) into the environment, which is not safe once
/// there are threads that read it. A context that wishes the same then writes nothing.
void set_software_threads(int threads);

/// Why no headless context can be made: a library that OpenGL is loaded from is missing, which libepoxy would
/// end the program over. Nothing where they are there; a driver may still be missing.
std::optional<Error> no_headless_gl();

/// A context without display or window, through EGL: surfaceless, else the first EGL device that gives
/// OpenGL 4.5, else the default display. Errors: no_headless_gl(), no EGL driver, none
/// with 4.5 core, or no such GPU.
Result<std::unique_ptr<Context>> make_headless_context(const HeadlessOptions& options = {});

/// A window and its context. Width and height in screen coordinates, 1–16384. Errors: no display, no
/// OpenGL 4.5.
Result<std::unique_ptr<Context>> make_window_context(const std::string& title, int width, int height);

/// A display server seems to be there (DISPLAY or WAYLAND_DISPLAY is set). Opening a window may still fail.
bool display_available();

}  // namespace slosh
