#include <imgui.h>

#include <CLI/CLI.hpp>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <thread>

#include "net/clock.h"
#include "net/text/clean.h"
#include "peer/app/common_options.h"
#include "peer/app/devices.h"
#include "peer/app/interrupt.h"
#include "peer/devices/hardware.h"
#include "peer/devices/room_tie.h"
#include "peer/devices/shared_space.h"
#include "peer/view/frame_builder.h"
#include "render/context.h"
#include "render/headset.h"
#include "render/renderer.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr const char* kDevicesCalibrateFooter =
    "Put the headset on and take one controller. Hold its grip to the device's tip, both still, and squeeze\n"
    "the grip button or the trigger: three times, at three corners of a triangle of at least 10 cm, the\n"
    "controller held the same way each time. Where the device stands in the room is then known, and kept\n"
    "beside the device's settings as NAME.room, if the runtime knows where the floor is (else a room begins\n"
    "wherever the head is, and nothing can be kept).\n"
    "\n"
    "From then on `--vr --device NAME` has the hand where your own hand is: the scene is placed so that it\n"
    "begins at the device's tip, and a metre of the device is a metre of the room (`scale` of the device's\n"
    "file is passed over). Calibrate again when the device was moved, or the room was set up anew.\n"
    "\n"
    "Examples:\n"
    "  slosh devices calibrate falcon\n"
    "  slosh devices calibrate plugin:./libomega.so";

struct CalibrateOptions {
  std::string spec;
  double seconds = 600.0;
};

/// Reads the device on a thread of its own, with no force.
class Reading {
 public:
  explicit Reading(Device& device)
      : thread_([this, &device] {
          const std::int64_t begin_ns = steady_now_ns();
          while (!over_) {
            try {
              heard_ = device.read({to_seconds(steady_now_ns() - begin_ns), 0.001}).heard;
              device.write(Wrench{});
            } catch (const std::exception&) {
              heard_ = false;
              over_ = true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          }
        }) {}
  ~Reading() {
    over_ = true;
    thread_.join();
  }
  bool heard() const { return heard_; }

 private:
  std::atomic<bool> over_{false};
  std::atomic<bool> heard_{false};
  std::thread thread_;
};

/// What is seen meanwhile: the controllers, and where places were touched.
class Step {
 public:
  explicit Step(Renderer& renderer) : renderer_(renderer) {
    const TriangleMesh ball = unit_ball();
    ball_ = renderer.add_mesh(ball.positions, ball.normals, ball.triangles);
  }
  void draw(const HeadsetPictures& pictures, const std::array<HandReading, 2>& hands,
            const std::vector<TouchedPlace>& places, const std::string& words) {
    Frame frame;
    const auto ball = [&](const glm::dvec3& at, float radius, const glm::vec3& color) {
      const glm::mat4 placed = glm::translate(glm::mat4(1.0f), glm::vec3(at));
      frame.meshes.push_back({ball_, glm::scale(placed, glm::vec3(radius)), {color, 0.0f, 0.5f, 1.0f}});
    };
    for (const HandReading& hand : hands)
      if (hand.tracked) ball(hand.pose.position, 0.02f, glm::vec3(0.18f));
    for (const TouchedPlace& place : places) ball(place.in_room, 0.012f, {0.1f, 0.5f, 0.15f});
    frame.hud = [&words] {
      ImGui::SetNextWindowPos(ImVec2(20.0f, 20.0f));
      ImGui::SetNextWindowSize(ImVec2(600.0f, 0.0f));
      ImGui::Begin("calibrate", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs);
      ImGui::TextWrapped("%s", words.c_str());
      ImGui::End();
    };
    if (renderer_.options().width != pictures.size.x || renderer_.options().height != pictures.size.y)
      renderer_.resize(pictures.size.x, pictures.size.y);
    renderer_.prepare(frame, pictures.views);
    renderer_.draw(pictures.views, pictures.targets);
    if (pictures.panel.texture != 0) renderer_.draw_panel(pictures.panel_size, pictures.panel);
  }

 private:
  Renderer& renderer_;
  MeshHandle ball_ = 0;
};

std::string next_words(const TouchPlaces& touched) {
  return "Place " + std::to_string(touched.places().size() + 1) + " of " + std::to_string(kPlacesToTouch) +
         ": hold the controller's grip to the device's tip, both still, and squeeze";
}

void say(const std::string& words) {
  std::printf("%s\n", words.c_str());
  std::fflush(stdout);
}

/// 1 m before the head, upright.
HeadsetPanel panel_before(const Pose& head) {
  const glm::dvec3 looks = head.orientation * glm::dvec3(0.0, 0.0, -1.0);
  const double angle = std::atan2(-looks.x, -looks.z);
  HeadsetPanel panel;
  panel.size = {0.8, 0.6};
  panel.pose.orientation = glm::angleAxis(angle, glm::dvec3(0.0, 1.0, 0.0));
  panel.pose.position = head.position + panel.pose.orientation * glm::dvec3(0.0, 0.0, -1.0);
  return panel;
}

int finish(const SharedSpace& space, const std::string& name, bool floor_known) {
  const glm::dvec3& p = space.device_in_room.position;
  say(format("The device stands at %.3f %.3f %.3f m in the room; the places fit within %.1f mm.", p.x, p.y,
             p.z, 1e3 * space.residual));
  if (!floor_known) {
    return fail({"devices calibrate", "the runtime does not know the floor: its room begins anew each time",
                 "Set up the room in the headset's own menu, and calibrate again"});
  }
  const std::filesystem::path file = shared_space_file(name);
  if (const Result<bool> kept = keep_shared_space(file, space); !kept) return fail(kept.error());
  say("Kept: " + clean_text(file.string(), kMaxTextBytes));
  return kExitOk;
}

int calibrate(const CalibrateOptions& options) {
  const auto tie = std::make_shared<RoomTie>(nullptr);
  HandPlace place;
  place.tie = tie;
  std::optional<Result<std::unique_ptr<Device>>> made = make_hardware(options.spec, place);
  if (made && !*made) return fail(made->error());
  if (!made || !is_tied(options.spec))
    return fail({"devices calibrate", "'" + clean_text(options.spec, 100) + "' tells no place of its own",
                 "Name a falcon or a plugin:FILE"});
  Device& device = *made->value();
  if (const Result<bool> opened = open_device(device); !opened) return fail(opened.error());
  Result<std::unique_ptr<Headset>> headset = Headset::find({});
  if (!headset) return fail(headset.error());
  auto context =
      headset.value()->takes_headless() ? make_headless_context({}) : make_window_context("slosh", 640, 480);
  if (!context) return fail(context.error());
  auto renderer = Renderer::create(*context.value(), {});
  if (!renderer) return fail(renderer.error());
  if (const Result<bool> started = headset.value()->start(*context.value()); !started)
    return fail(started.error());

  catch_interrupts();
  Step stage(*renderer.value());
  TouchPlaces touched;
  std::string words = next_words(touched);
  say(words);
  int code = 128;
  {
    Reading reading(device);
    const std::shared_ptr<HeadsetHands> hands = headset.value()->hands();
    std::optional<HeadsetPanel> panel;
    const std::int64_t begin_ns = steady_now_ns();
    std::optional<SharedSpace> found;
    while (!found && interrupted_by() == 0 && to_seconds(steady_now_ns() - begin_ns) < options.seconds) {
      context.value()->poll();
      const HeadsetState state = headset.value()->poll();
      if (const std::string problem = headset.value()->take_problem(); !problem.empty())
        std::fprintf(stderr, "slosh: %s\n", clean_text(problem, kMaxTextBytes).c_str());
      if (state == HeadsetState::kLost || state == HeadsetState::kEnded) break;
      if (state == HeadsetState::kAway) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        continue;
      }
      const std::array<HandReading, 2> seen{hands->read(HandSide::kLeft), hands->read(HandSide::kRight)};
      headset.value()->frame(
          [&](const Pose& head) {
            if (!panel) panel = panel_before(head);
            return HeadsetPlaces{RoomInWorld{}, *panel};
          },
          [&](const HeadsetPictures& pictures) { stage.draw(pictures, seen, touched.places(), words); });
      const std::optional<Pose> tip = reading.heard() ? tie->tip() : std::nullopt;
      const auto heard = touched.follow(to_seconds(steady_now_ns() - begin_ns),
                                        tip ? std::optional(tip->position) : std::nullopt, seen[0], seen[1]);
      using Heard = TouchPlaces::Heard;
      if (heard == Heard::kNothing) continue;
      if (heard == Heard::kMoved)
        words = "It moved, or the device says nothing: hold both still. " + next_words(touched);
      if (heard == Heard::kTooNear)
        words = "That is a place touched before: go 10 cm on. " + next_words(touched);
      if (heard == Heard::kTaken && !touched.complete()) words = next_words(touched);
      if (touched.complete()) {
        const Result<SharedSpace> fitted = fit_shared_space(touched.places());
        if (fitted) {
          found = fitted.value();
          break;
        }
        touched.again();
        words = fitted.error().text() + ". " + next_words(touched);
      }
      say(words);
    }
    if (found)
      code = finish(*found, tie->name(), headset.value()->floor_known());
    else if (interrupted_by() != 0)
      code = 128 + interrupted_by();
    else
      code = fail({"devices calibrate", "three places were not touched",
                   "Is the headset on, and the controller awake?"});
  }
  headset.value()->stop();
  device.close();
  return code;
}

}  // namespace

void add_devices_calibrate(CLI::App& devices, VerbRun& chosen) {
  CLI::App* verb =
      devices.add_subcommand("calibrate", "A haptic device and a headset in one space: touch three places");
  auto o = std::make_shared<CalibrateOptions>();
  verb->add_option("NAME", o->spec, "The device, as for --device: falcon or plugin:FILE")->required();
  verb->add_option("--seconds", o->seconds, "Give up after")
      ->check(in_range(1.0, 1e6))
      ->capture_default_str();
  verb->footer(kDevicesCalibrateFooter);
  verb->callback([&chosen, o] { chosen = [o] { return calibrate(*o); }; });
}

}  // namespace slosh
