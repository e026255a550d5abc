// A headset beside a run: placed before the scene once, found again when it was lost, never in the run's way.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "peer/devices/headset_link.h"
#include "render/headset.h"
#include "scenes/scene.h"

namespace slosh {

/// What was asked for beside `--vr`.
struct HeadsetWish {
  double scale = 1.0;       ///< how many times as large as it is the world looks, 0.1–10
  double height = -1.0;     ///< m above the floor of what hands go to; below 0: a little below the eyes
  double resolution = 1.0;  ///< as HeadsetOptions
};

/// Where `scene` is to be before who wears the headset: its hands' places within reach, seen the way its
/// camera looks; two handles side by side.
AnchorWish anchor_wish(const Scene& scene, const HeadsetWish& wish);
/// Where the HUD stands in a room that was placed by `wish` about a head at `head`: behind the scene, above
/// it.
HeadsetPanel panel_place(const Pose& head, const AnchorWish& wish);

/// On the thread that draws.
class HeadsetView {
 public:
  /// Errors: as Headset::find.
  static Result<std::unique_ptr<HeadsetView>> find(const HeadsetWish& wish);

  /// For the controllers; never null.
  const std::shared_ptr<HeadsetLink>& link() const { return link_; }
  const Headset& headset() const { return *headset_; }

  /// Begins to show `scene`; both must outlive the view's use. Errors: as Headset::start.
  Result<bool> start(Context& context, const Scene& scene, std::function<void(const std::string&)> tell);

  /// Gives the headset back, while the context of start() is there and current.
  void stop() { headset_->stop(); }

  enum class Turn : std::uint8_t {
    kNotSeen,  ///< nobody looks: show the window, or sleep
    kDrawn,    ///< `draw` drew a frame, which was handed over
    kEnded,    ///< the person ended the program in the headset
  };
  /// One turn of the loop: takes in what the runtime said, waits for its pace where it sets one, has `draw`
  /// draw. A headset that was lost is looked for again, every two seconds.
  Turn turn(const std::function<void(const HeadsetPictures&)>& draw);
  /// Hands are followed and the room is placed: a run may begin.
  bool ready() const { return state_ == HeadsetState::kFocused && link_->room().has_value(); }

  /// The controllers that are seen, in the world.
  std::vector<Pose> controllers() const;

 private:
  HeadsetView(std::unique_ptr<Headset> headset, const HeadsetWish& wish);
  bool find_again();

  std::unique_ptr<Headset> headset_;
  HeadsetWish wish_;
  std::shared_ptr<HeadsetLink> link_;
  AnchorWish anchor_;
  HeadsetPanel panel_;
  Context* context_ = nullptr;
  std::function<void(const std::string&)> tell_;
  HeadsetState state_ = HeadsetState::kAway;
  std::int64_t panel_ns_ = 0;   // when it was last drawn
  std::int64_t looked_ns_ = 0;  // for one that was lost
  std::string refusal_;         // why it is not back, as told
};

}  // namespace slosh
