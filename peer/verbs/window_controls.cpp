#include "peer/verbs/window_controls.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "net/clock.h"

namespace slosh {
namespace {

/// What Down and Up go through.
constexpr std::array kPaces{1.0, 0.5, 0.25, 0.1, 0.05};
constexpr int kManySteps = 10;

double wall_seconds() {
  return to_seconds(steady_now_ns());
}

std::vector<std::string> names_of_fluids(const Scene& scene) {
  std::vector<std::string> names;
  for (const Fluid& fluid : scene.fluids) names.push_back(fluid.name);
  return names;
}

}  // namespace

WindowControls::WindowControls(const Scene& scene, LiveRun& run, OrbitCamera& camera,
                               std::function<void(const std::string&)> tell)
    : scene_(scene),
      run_(run),
      camera_(camera),
      tell_(std::move(tell)),
      grab_(scene),
      panel_(names_of_fluids(scene)),
      lent_(scene.grips.size(), nullptr),
      hands_(scene.grips.size()) {}

void WindowControls::say(const std::string& text) {
  guide_.say(text, wall_seconds());
  tell_("slosh: " + text);
}

WindowControls::Wish WindowControls::follow(const InputState& input, const glm::ivec2& picture,
                                            const BodySnapshot* world) {
  for (std::size_t i = 0; i < lent_.size(); ++i) lent_[i] = run_.lent_hand(i);
  for (const std::string& line : run_.take_refusals()) say(line);
  for (const LiveWish& wish : panel_.take_wishes()) run_.change(wish);
  const Wish wish = input.hud_wants_keyboard ? Wish::kNothing : follow_keys(input);
  if (wish == Wish::kEnd || wish == Wish::kAgain) return wish;
  if (world != nullptr) follow_mouse(input, picture, *world);
  learn(picture);
  return wish;
}

WindowControls::Wish WindowControls::follow_keys(const InputState& input) {
  if (input.pressed(Key::kEscape) || input.pressed(Key::kQ)) return Wish::kEnd;
  if (input.pressed(Key::kR)) {
    reset_hands();
    if (!run_.start_again()) return Wish::kAgain;
  }
  if (input.pressed(Key::kH)) {
    guide_.show_all = !guide_.show_all;
    guide_.note(WindowGuide::Used::kKeys);
  }
  if (input.pressed(Key::kC)) camera_.reset();
  if (input.pressed(Key::kSpace)) run_.pause(!run_.paused());
  if (input.pressed(Key::kG)) run_.change_grip();
  if (input.pressed(Key::kTab)) panel_.shown = !panel_.shown;
  if (input.pressed(Key::kB)) {
    reset_hands();
    guide_.note(WindowGuide::Used::kGiveBack);
  }
  follow_pace(input, run_.live_values());
  return input.pressed(Key::kP) ? Wish::kPicture : Wish::kNothing;
}

void WindowControls::follow_pace(const InputState& input, const LiveValues& values) {
  if (!values.may_pace) return;
  if (input.pressed(Key::kN)) {
    if (!run_.paused()) run_.pause(true);
    run_.step_standing(input.held(Key::kShift) ? kManySteps : 1);
  }
  const bool slower = input.pressed(Key::kDown);
  if (!slower && !input.pressed(Key::kUp)) return;
  // From the nearest of them: a slider may have set any.
  const auto nearest = std::min_element(kPaces.begin(), kPaces.end(), [&](double a, double b) {
    return std::abs(a - values.pace) < std::abs(b - values.pace);
  });
  const auto at = nearest - kPaces.begin() + (slower ? 1 : -1);
  const auto last = static_cast<std::ptrdiff_t>(kPaces.size()) - 1;
  run_.change(
      {LiveWish::Kind::kPace, 0, kPaces[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, last))]});
}

void WindowControls::follow_mouse(const InputState& input, const glm::ivec2& picture,
                                  const BodySnapshot& world) {
  facts_.mouse_is_hand = false;
  for (std::size_t i = 0; i < hands_.size(); ++i) facts_.mouse_is_hand |= run_.mouse_target(i) != nullptr;
  if (facts_.mouse_is_hand) {
    follow_mouse_hands(input, picture);
    return;
  }
  const bool held_before = grab_.held().has_value();
  if (!grab_.follow(input, camera_, picture, world, lent_)) {
    camera_.follow(input, picture.y);
    return;
  }
  if (!held_before) guide_.note(WindowGuide::Used::kGrab);
  if (grab_.ever_tilted()) guide_.note(WindowGuide::Used::kTilt);
}

/// --device mouse: the pointer is the handle, and only the left button turns the camera.
void WindowControls::follow_mouse_hands(const InputState& input, const glm::ivec2& picture) {
  if (input.held(MouseButton::kLeft)) {
    InputState camera_input = input;
    camera_input.scroll = glm::vec2(0.0f);
    camera_.follow(camera_input, picture.y);
  }
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    MouseTarget* const target = run_.mouse_target(i);
    if (target != hands_[i].target) hands_[i] = {target, MouseHand(target ? target->back() : Pose{})};
    if (target != nullptr && hands_[i].mouse.follow(input, camera_, picture.y)) {
      target->back() = hands_[i].mouse.wanted();
      target->publish();
    }
  }
}

/// What the guide is to say.
void WindowControls::learn(const glm::ivec2& picture) {
  const LiveValues values = run_.live_values();
  const HudFacts run = run_.facts(1.0);
  facts_.can_grab =
      std::any_of(lent_.begin(), lent_.end(), [](const LentHand* hand) { return hand != nullptr; });
  facts_.shared = run.shared;
  facts_.may_change = run.may_change;
  facts_.may_pace = values.may_pace;
  facts_.pace = values.pace;
  facts_.paused = run_.paused();
  facts_.holding = grab_.held().has_value();
  facts_.taken = grab_.any_taken();
  facts_.over.clear();
  facts_.mark.reset();
  const std::optional<Grabbed>& what = grab_.held() ? grab_.held() : grab_.over();
  if (!what) return;
  if (camera_.depth_of(what->place) > 0.0 && (what->grip >= 0 || facts_.holding))
    facts_.mark = glm::vec2(camera_.pixel_of(what->place, picture));
  const std::string& name = what->grip >= 0 ? scene_.grips[static_cast<std::size_t>(what->grip)].name
                                            : scene_.bodies[static_cast<std::size_t>(what->body)].name;
  facts_.over = "drag: move " + name + (what->grip >= 0 ? "" : " with all its hands");
}

void WindowControls::reset_hands() {
  grab_.give_back(lent_);
}

void WindowControls::draw() {
  guide_.draw(facts_, wall_seconds());
  panel_.draw(run_.live_values(), wall_seconds());
}

}  // namespace slosh
