#include "peer/view/headset_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "net/clock.h"
#include "net/grip_start.h"

namespace slosh {
namespace {

constexpr double kApart = 0.05;      // m, level, between handles for two hands
constexpr double kReach = 0.5;       // m from the head to the scene: half-bent arms
constexpr double kLookAgain = 2.0;   // s
constexpr double kPanelEvery = 0.1;  // s: its numbers are read, not watched
constexpr glm::ivec2 kPanelPixels{640, 480};
constexpr glm::dvec2 kPanelSize{0.8, 0.6};  // m: 12 pixels a degree at arm's length and a half

}  // namespace

AnchorWish anchor_wish(const Scene& scene, const HeadsetWish& wish) {
  AnchorWish anchor;
  anchor.focus = scene.camera.target;
  if (!scene.grips.empty()) {
    anchor.focus = glm::dvec3(0.0);
    for (std::size_t i = 0; i < scene.grips.size(); ++i)
      anchor.focus += grip_start(scene, i).position / static_cast<double>(scene.grips.size());
  }
  anchor.facing = scene.camera.target - scene.camera.eye;
  if (scene.grips.size() == 2) {
    // One handle for each hand: square to the line between them, from the camera's side.
    const glm::dvec3 apart = grip_start(scene, 1).position - grip_start(scene, 0).position;
    const glm::dvec3 square = glm::cross(glm::dvec3(0.0, 1.0, 0.0), apart);
    if (glm::length(square) > kApart)
      anchor.facing = glm::dot(square, anchor.facing) < 0.0 ? -square : square;
  }
  anchor.scale = 1.0 / wish.scale;
  // What looks large is looked at from farther away.
  anchor.distance = kReach * std::max(1.0, wish.scale);
  anchor.height = wish.height;
  return anchor;
}

HeadsetPanel panel_place(const Pose& head, const AnchorWish& wish) {
  const glm::dvec3 looks = head.orientation * glm::dvec3(0.0, 0.0, -1.0);
  const double level = std::hypot(looks.x, looks.z);
  const glm::dvec3 ahead =
      level < 1e-9 ? glm::dvec3(0.0, 0.0, -1.0) : glm::dvec3(looks.x, 0.0, looks.z) / level;
  const double scene_height = wish.height >= 0.0 ? wish.height : head.position.y - wish.below_eyes;
  HeadsetPanel panel;
  panel.size = kPanelSize * (wish.distance / kReach);
  panel.pose.position = head.position + 1.8 * wish.distance * ahead;
  panel.pose.position.y = scene_height + 0.6 * panel.size.y;
  panel.pose.orientation = glm::angleAxis(std::atan2(-ahead.x, -ahead.z), glm::dvec3(0.0, 1.0, 0.0));
  return panel;
}

HeadsetView::HeadsetView(std::unique_ptr<Headset> headset, const HeadsetWish& wish)
    : headset_(std::move(headset)),
      wish_(wish),
      link_(std::make_shared<HeadsetLink>(headset_->hands(), 1.0 / wish.scale)) {}

Result<std::unique_ptr<HeadsetView>> HeadsetView::find(const HeadsetWish& wish) {
  HeadsetOptions options;
  options.resolution = wish.resolution;
  options.panel_size = kPanelPixels;
  // As near as a hand comes to an eye, and far behind the scene, in a world of any size.
  options.near_plane = 0.03 / wish.scale;
  options.far_plane = 20.0 * std::max(1.0, 1.0 / wish.scale);
  Result<std::unique_ptr<Headset>> found = Headset::find(options);
  if (!found) return found.error();
  return std::unique_ptr<HeadsetView>(new HeadsetView(std::move(found.value()), wish));
}

Result<bool> HeadsetView::start(Context& context, const Scene& scene,
                                std::function<void(const std::string&)> tell) {
  context_ = &context;
  tell_ = std::move(tell);
  anchor_ = anchor_wish(scene, wish_);
  const Result<bool> started = headset_->start(context);
  if (started && wish_.height >= 0.0 && !headset_->floor_known()) {
    anchor_.height = -1.0;
    tell_("headset: the runtime does not know where the floor is, so --vr-height says nothing");
  }
  return started;
}

bool HeadsetView::find_again() {
  const std::int64_t now_ns = steady_now_ns();
  if (now_ns - looked_ns_ < to_nanoseconds(kLookAgain)) return false;
  looked_ns_ = now_ns;
  const Result<bool> started = headset_->start(*context_);
  if (!started) {
    if (std::exchange(refusal_, started.error().text()) != started.error().text()) tell_(refusal_);
    return false;
  }
  refusal_.clear();
  tell_("headset: it is back (" + headset_->description() + ")");
  return true;
}

HeadsetView::Turn HeadsetView::turn(const std::function<void(const HeadsetPictures&)>& draw) {
  const HeadsetState before = state_;
  state_ = headset_->poll();
  if (const std::string problem = headset_->take_problem(); !problem.empty()) tell_(problem);
  if (state_ == HeadsetState::kEnded) return Turn::kEnded;
  if (state_ == HeadsetState::kLost) {
    if (before != HeadsetState::kLost) {
      headset_->stop();
      looked_ns_ = steady_now_ns();
    }
    find_again();
    return Turn::kNotSeen;
  }
  if (state_ == HeadsetState::kAway) return Turn::kNotSeen;

  const std::int64_t now_ns = steady_now_ns();
  bool renewed = false;
  const auto places = [&](const Pose& head) {
    std::optional<RoomInWorld> room = link_->room();
    if (!room) {  // once: the world never moves the head
      room = anchor_room(head, anchor_);
      // Where an arm was calibrated the scene comes to it: its hand is where the arm's tip is.
      if (const std::optional<LeadingHand> arm = link_->leading())
        room->origin += arm->in_world - room->to_world(Pose{arm->in_room, {}}).position;
      panel_ = panel_place(head, anchor_);
      link_->place(*room);
    }
    panel_.renewed = renewed = now_ns - panel_ns_ >= to_nanoseconds(kPanelEvery);
    return HeadsetPlaces{*room, panel_};
  };
  const bool drawn = headset_->frame(places, draw);
  if (drawn && renewed) panel_ns_ = now_ns;
  if (const std::string problem = headset_->take_problem(); !problem.empty()) tell_(problem);
  return drawn ? Turn::kDrawn : Turn::kNotSeen;
}

std::vector<Pose> HeadsetView::controllers() const {
  std::vector<Pose> seen;
  const std::optional<RoomInWorld> room = link_->room();
  if (!room) return seen;
  for (const HandSide side : {HandSide::kLeft, HandSide::kRight}) {
    const HandReading reading = link_->hands->read(side);
    if (reading.tracked) seen.push_back(room->to_world(reading.pose));
  }
  return seen;
}

}  // namespace slosh
