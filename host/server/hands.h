// What moves each grip: a person's samples, or the host's own stand until somebody has taken hold.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "net/channel.h"
#include "net/wire/messages.h"
#include "scenes/scene.h"

namespace slosh {

/// How a grip's samples arrived. Numbers, not repeats, are counted.
struct Delivery {
  std::uint64_t received = 0;  ///< distinct samples that came
  std::uint64_t expected = 0;  ///< numbers from the first to the newest
};

/// The writer of every channel.pose(i). A grip that nobody has held since the start (or a reset) is held by
/// the host where it starts, so that nothing falls before people come: it is on a stand, which counts as
/// nobody (PoseMessage::stand). The first person's hand that is felt on a body ends the stands of its other
/// grips that nobody has taken; from then on only hands hold it. One thread; `now_ns` is the steady clock.
class HandTable {
 public:
  HandTable(const Scene& scene, Channel& channel);

  /// Puts every grip without a holder on its stand: at the start and after a reset.
  void stand_all(std::int64_t now_ns);
  /// A new holder, whose samples number anew. The stand holds on until its first engaged sample that is felt;
  /// then the world is told that it is another hand (PoseMessage::hold), and engages it as net/engagement.h
  /// has it.
  void taken(std::size_t grip, std::int64_t now_ns);
  /// Not held any more: the host disengages gently. A stand stays, unless `also_stand`.
  void let_go(std::size_t grip, std::int64_t now_ns, bool also_stand = false);
  /// Contact with the holder is lost. Where updates of another hand of the same body come, it carries on
  /// alone: as let_go(). Else the host holds the grip where the hand was, since nobody would catch what
  /// falls.
  void lose(std::size_t grip, std::int64_t now_ns);
  /// After a restart of the host: what was held stands where the hand was, until its holder is back.
  /// `awaited`: whether somebody may come back to it, one a grip; who is missing there may.
  void carry_on(const BodySnapshot& bodies, std::int64_t now_ns, const std::vector<bool>& awaited = {});

  /// Takes in a sample of the holder's. True when it is the newest. It goes to the world, but where it holds
  /// on and is not felt: it is answered then (used()), and what the world has of the grip stays: the stand,
  /// or a hand that is silent, or nothing. Else who lifts before their force has begun would move the body by
  /// a spring that nobody feels, and begin with all of that. `counted`: its energy is told (wire::kCouplings
  /// is agreed with the holder).
  bool sample(const wire::PoseSample& sample, std::int64_t now_ns, bool counted = false);

  struct Used {
    std::uint64_t number = 0;   ///< the holder's; 0 = none of the holder's samples, or it is too long ago
    std::int64_t stamp_ns = 0;  ///< on the holder's clock
  };
  /// From BodyMessage::pose_numbers to the holder's sample, or to a newer one that is not felt: never back,
  /// also not in states that were made before the first one that is felt came.
  Used used(std::size_t grip, std::uint64_t pose_number) const;
  const Delivery& delivery(std::size_t grip) const { return grips_[grip].delivery; }
  bool on_stand(std::size_t grip) const { return grips_[grip].stand; }
  std::size_t size() const { return grips_.size(); }

 private:
  static constexpr std::size_t kRemembered = 2048;  // stamps: 4 s at 500 a second
  struct GripHand {
    Pose start;  // as the scene has it
    int body = 0;
    bool stand = false;
    bool kept = false;  // the stand is for who lost contact, and may come back to it
    bool held = false;
    std::uint32_t hold = 0;    // PoseMessage::hold
    std::uint64_t base = 0;    // added to the holder's numbers, so that they rise over all holders
    std::uint64_t newest = 0;  // holder's number; 0 = none yet
    std::uint64_t first = 0;
    std::uint64_t answered = 0;        // holder's number of the newest sample that was not felt; 0 = none
    std::uint64_t seen = 0;            // bit i: newest − i came
    std::int64_t clock_offset_ns = 0;  // host's clock − holder's, by the quickest sample
    std::int64_t received_ns = 0;
    Delivery delivery;
    Pose last;                // of what was published last,
    bool engaged = false;     // whether it held on,
    double energy = 0.0;      // and J that all who held it put in
    double before = 0.0;      // J of that before this holder's count began …
    bool begun = false;       // … as it did
    std::vector<Used> known;  // a ring by number
  };
  bool count(GripHand& hand, std::uint64_t number);
  std::int64_t on_our_clock(GripHand& hand, std::int64_t stamp_ns, std::int64_t now_ns);
  void put_on_stand(std::size_t grip, const Pose& pose, std::int64_t now_ns, bool kept);
  void end_stands_beside(std::size_t grip, std::int64_t now_ns);
  void publish(std::size_t grip, const PoseMessage& message);
  bool another_is_fresh(std::size_t grip, std::int64_t now_ns) const;

  Channel& channel_;
  std::vector<GripHand> grips_;
};

}  // namespace slosh
