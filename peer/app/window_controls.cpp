#include "peer/app/window_controls.h"

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

template <class T>
std::vector<std::string> names(const std::vector<T>& things) {
  std::vector<std::string> all;
  for (const T& thing : things) all.push_back(thing.name);
  return all;
}

}  // namespace

WindowControls::WindowControls(const Scene& scene, LiveRun& run, OrbitCamera& camera, KeyBindings keys,
                               KeptViews views, std::function<void(const std::string&)> tell)
    : scene_(scene),
      run_(run),
      camera_(camera),
      tell_(std::move(tell)),
      grab_(scene),
      keys_(keys),
      guide_(std::move(keys)),
      forces_(scene),
      views_(std::move(views)),
      panel_(names(scene.fluids), names(scene.grips)),
      lent_(scene.grips.size(), nullptr),
      hands_(scene.grips.size()) {
  if (!views_.problem().empty()) tell_("slosh: " + views_.problem());
}

void WindowControls::say(const std::string& text) {
  guide_.say(text, wall_seconds());
  tell_("slosh: " + text);
}

WindowControls::Wish WindowControls::follow(const InputState& input, const glm::ivec2& picture,
                                            const BodySnapshot* world) {
  for (std::size_t i = 0; i < lent_.size(); ++i) lent_[i] = run_.lent_hand(i);
  for (const std::string& line : run_.take_notices()) say(line);
  for (const LiveWish& wish : panel_.take_wishes()) {
    if (wish.kind == LiveWish::Kind::kFilter)
      filter = static_cast<int>(std::lround(wish.value));
    else
      run_.change(wish);
  }
  const Wish wish = input.hud_wants_keyboard ? Wish::kNothing : follow_keys(input);
  if (wish == Wish::kEnd) return wish;
  if (world != nullptr) follow_mouse(input, picture, *world);
  learn(picture);
  return wish;
}

/// Keys in the order in which they were pressed: a step and "go on" within one slow picture are not "go on"
/// and a step.
WindowControls::Wish WindowControls::follow_keys(const InputState& input) {
  Wish wish = Wish::kNothing;
  for (const KeyPress& press : input.presses) {
    const std::optional<WindowAction> action = keys_.action_of(press.key);
    if (!action) continue;
    const Wish one = follow_key(*action, press.shift);
    if (one == Wish::kEnd) return one;
    if (one != Wish::kNothing) wish = one;
  }
  return wish;
}

WindowControls::Wish WindowControls::follow_key(WindowAction action, bool shift) {
  switch (action) {
    case WindowAction::kEnd:
      return Wish::kEnd;
    case WindowAction::kAgain:
      reset_hands();
      run_.start_again();
      break;
    case WindowAction::kHelp:
      guide_.show_all = !guide_.show_all;
      guide_.note(WindowGuide::Used::kKeys);
      break;
    case WindowAction::kCameraBack:
      camera_.reset();
      break;
    case WindowAction::kPause:
      run_.pause(!run_.paused());
      break;
    case WindowAction::kGrip:
      run_.change_grip();
      break;
    case WindowAction::kSliders:
      panel_.shown = !panel_.shown;
      break;
    case WindowAction::kGiveBack:
      reset_hands();
      guide_.note(WindowGuide::Used::kGiveBack);
      break;
    case WindowAction::kStep:
    case WindowAction::kSlower:
    case WindowAction::kFaster:
      follow_pace(action, shift);
      break;
    case WindowAction::kPicture:
      return Wish::kPicture;
    case WindowAction::kParticles:
      guide_.say(std::string("shown: ") + measures_.next_particles(), wall_seconds());
      break;
    case WindowAction::kAxes:
      measures_.axes = !measures_.axes;
      break;
    case WindowAction::kForces:
      forces_.shown = !forces_.shown;
      break;
    case WindowAction::kView1:
    case WindowAction::kView2:
    case WindowAction::kView3:
    case WindowAction::kView4:
      follow_view(static_cast<std::size_t>(action) - static_cast<std::size_t>(WindowAction::kView1), shift);
      break;
    case WindowAction::kCount:
      break;
  }
  return Wish::kNothing;
}

void WindowControls::follow_view(std::size_t number, bool keep) {
  const std::string key =
      keys_.shown(static_cast<WindowAction>(static_cast<std::size_t>(WindowAction::kView1) + number));
  if (keep) {
    const Result<bool> kept = views_.keep(number, camera_.look());
    const std::string back = key + " brings this view back";
    if (kept)
      guide_.say("kept: " + back, wall_seconds());
    else
      say(back + " in this run; " + kept.error().text());
  } else if (views_.view(number)) {
    camera_.look(*views_.view(number));
  } else {
    guide_.say("no view is kept there yet: Shift + " + key + " keeps this one", wall_seconds());
  }
}

void WindowControls::follow_pace(WindowAction action, bool shift) {
  const LiveValues values = run_.live_values();
  if (!values.may_pace) return;
  if (action == WindowAction::kStep) {
    if (!run_.paused()) run_.pause(true);
    run_.step_standing(shift ? kManySteps : 1);
    return;
  }
  const bool slower = action == WindowAction::kSlower;
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
      std::any_of(lent_.begin(), lent_.end(), [](const SharedHandle* hand) { return hand != nullptr; });
  facts_.shared = run.shared;
  facts_.may_change = run.may_change;
  facts_.may_pace = values.may_pace;
  facts_.pace = values.pace;
  facts_.paused = run_.paused();
  facts_.hands = scene_.grips.size();
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

void WindowControls::record(const Snapshot& snapshot) {
  measures_.record(snapshot);
  forces_.record(snapshot.rigid);
}

void WindowControls::draw(const Snapshot& snapshot, const glm::ivec2& picture, std::span<const Rect> taken) {
  const auto pressures = run_.pressures(measures_.particles == ParticleView::kPressure);
  measures_.draw(snapshot, pressures.get(), camera_, picture);
  guide_.draw(facts_, wall_seconds(), taken);
  LiveValues values = run_.live_values();
  values.filter = filter;
  panel_.draw(values, wall_seconds(), taken);
  forces_.draw();
}

}  // namespace slosh
