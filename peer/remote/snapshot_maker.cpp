#include "peer/remote/snapshot_maker.h"

#include <pthread.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "net/clock.h"

namespace slosh {
namespace {

constexpr std::size_t kMaxInbox = std::size_t{16} << 20;  // bytes of pieces that wait
constexpr std::int64_t kFeedbackGap_ns = 100'000'000;
constexpr auto kTurn = std::chrono::milliseconds(10);
// Frames that a missing piece is waited for. A film is in no hurry.
constexpr std::uint32_t kWindowPatience = 1;
constexpr std::uint32_t kFilmPatience = 6;
constexpr double kWithoutBodies = 0.3;     // s that a film waits for body states once it has particles
constexpr double kWithoutParticles = 1.0;  // s that it waits for particles once it has body states

}  // namespace

SnapshotMaker::SnapshotMaker(const SnapshotMakerOptions& options, SnapshotQueue& film)
    : options_(options), film_(film), times_(options.frames_per_second) {
  shown_.restart();
  thread_ = std::thread([this] { run(); });
}

SnapshotMaker::~SnapshotMaker() {
  finish();
}

void SnapshotMaker::offer(std::span<const std::uint8_t> datagram) {
  {
    const std::lock_guard lock(inbox_mutex_);
    if (inbox_bytes_ + datagram.size() > kMaxInbox) {
      overrun_ += 1;
      return;
    }
    inbox_bytes_ += datagram.size();
    inbox_.emplace_back(datagram.begin(), datagram.end());
  }
  changed_.notify_one();
}

void SnapshotMaker::note_bodies(const BodyMessage& bodies) {
  const std::lock_guard lock(mutex_);
  history_.add(bodies.run, bodies.bodies);
}

void SnapshotMaker::note_hand(std::uint32_t run, std::size_t grip, double time, const Pose& pose,
                              bool engaged) {
  const std::lock_guard lock(mutex_);
  history_.add_hand(run, grip, time, pose, engaged);
}

void SnapshotMaker::note_moment(const WorldMoment& moment) {
  const std::lock_guard lock(mutex_);
  if (moment.run != moment_.run) shown_.restart();
  moment_ = moment;
}

void SnapshotMaker::note_clock(const ClockSync& clock) {
  const std::lock_guard lock(mutex_);
  clock_ = clock;
}

void SnapshotMaker::restart() {
  {
    const std::lock_guard lock(inbox_mutex_);
    inbox_.clear();
    inbox_bytes_ = 0;
    feedback_.clear();
    anew_ = true;
  }
  const std::lock_guard lock(mutex_);
  history_.restart();
  shown_.restart();
  moment_.known = false;
}

std::vector<SharedBytes> SnapshotMaker::take_feedback() {
  const std::lock_guard lock(inbox_mutex_);
  return std::exchange(feedback_, {});
}

void SnapshotMaker::finish() {
  {
    const std::lock_guard lock(inbox_mutex_);
    finish_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

double SnapshotMaker::world_time(std::int64_t now_ns) const {
  return moment_.time_at(clock_.to_host(now_ns));
}

SnapshotPointer SnapshotMaker::newest(std::int64_t now_ns) {
  std::optional<Between> between;
  {
    const std::lock_guard lock(mutex_);
    if (!moment_.known) return nullptr;
    const double world = world_time(now_ns);
    const double time = shown_.at(world, now_ns);
    between = history_.at(time);
    if (!between || (options_.has_fluid && !between->before)) return nullptr;
    if (time == last_shown_ && between->after.get() == last_frame_) return nullptr;
    last_shown_ = time;
    last_frame_ = between->after.get();
    history_.forget_before(time);
    const double newest = options_.has_fluid ? std::min(time, history_.last_frame_time()) : time;
    report_.age.add(std::max(world - newest, 0.0));
    report_.shown += 1;
    if (report_.first_shown_ns == 0) {
      report_.first_shown_ns = now_ns;
      report_.first_shown_time = time;
    }
    report_.last_shown_time = time;
    report_.delay = shown_.delay();
  }
  return blend(*between);
}

SnapshotReport SnapshotMaker::report() const {
  SnapshotReport report;
  {
    const std::lock_guard lock(mutex_);
    report = report_;
  }
  const std::lock_guard lock(inbox_mutex_);
  report.overrun = overrun_;
  return report;
}

double SnapshotMaker::delay() const {
  const std::lock_guard lock(mutex_);
  return report_.delay;
}

void SnapshotMaker::run() {
  pthread_setname_np(pthread_self(), "slosh-snapshots");
  std::vector<std::vector<std::uint8_t>> pieces;
  for (;;) {
    bool anew = false;
    bool finish = false;
    pieces.clear();
    {
      // Before the pieces: what was offered before these states is decoded when they are compared with it.
      const std::lock_guard lock(mutex_);
      if (history_.has_bodies()) bodies_received_to_ = history_.last_body_time();
    }
    {
      std::unique_lock lock(inbox_mutex_);
      changed_.wait_for(lock, kTurn, [this] { return !inbox_.empty() || finish_; });
      pieces.swap(inbox_);
      inbox_bytes_ = 0;
      anew = std::exchange(anew_, false);
      finish = finish_;
    }
    take_pieces(pieces, anew, finish);
    if (options_.film) make_film(finish);
    if (finish) break;
    if (options_.wanted) make_feedback();
  }
  film_.close();
}

void SnapshotMaker::take_pieces(const std::vector<std::vector<std::uint8_t>>& pieces, bool anew,
                                bool to_the_end) {
  if (anew) decoders_ = StreamDecoders();
  const std::uint32_t patience = options_.film ? kFilmPatience : kWindowPatience;
  for (const std::vector<std::uint8_t>& piece : pieces) {
    const wire::Fault fault = decoders_.take(piece);
    {
      const std::lock_guard lock(mutex_);
      report_.bytes += piece.size();
      if (fault) {
        report_.refused += 1;
        report_.last_fault = fault.text();
      }
    }
    while (std::optional<DecodedFrame> frame = decoders_.next(patience)) take_frame(std::move(*frame));
  }
  if (to_the_end) {
    while (std::optional<DecodedFrame> frame = decoders_.next(0)) take_frame(std::move(*frame));
  }
}

void SnapshotMaker::take_frame(DecodedFrame frame) {
  const std::lock_guard lock(mutex_);
  report_.frames += 1;
  if (frame.complete >= 1.0) report_.whole += 1;
  if (moment_.known && frame.run == moment_.run) {
    shown_.arrived(frame.time, world_time(steady_now_ns()));
  }
  history_.add(std::move(frame));
}

std::optional<Between> SnapshotMaker::next_of_film(bool to_the_end) {
  const std::lock_guard lock(mutex_);
  const bool particles = history_.has_frames();
  if (!history_.has_bodies() || (options_.has_fluid && !particles)) return std::nullopt;
  const double bodies_to = history_.last_body_time();
  const double particles_to = particles ? history_.last_frame_time() : bodies_to;
  const double first = particles ? history_.first_frame_time() : history_.first_body_time();
  if (!times_.started() || film_run_ != history_.run()) times_.start(first);
  film_run_ = history_.run();
  times_.follow(particles_to);

  const double time = times_.next();
  const double reached = std::max(particles_to, bodies_to);
  const bool both = time <= particles_to + 1e-9 && time <= bodies_to + 1e-9;
  // Particles that wait to be decoded are not late: a busy machine's film is made later, not worse.
  const double received_to = std::min(bodies_to, bodies_received_to_);
  const bool one_is_late = (time <= particles_to && time + kWithoutBodies < particles_to) ||
                           (time <= received_to && time + kWithoutParticles < received_to);
  if (!both && !one_is_late && !(to_the_end && time <= reached)) return std::nullopt;
  std::optional<Between> between = history_.at(time);
  if (!between) return std::nullopt;
  times_.taken();
  history_.forget_before(time);
  const std::int64_t now_ns = steady_now_ns();
  if (moment_.known) report_.age.add(std::max(world_time(now_ns) - time, 0.0));
  report_.shown += 1;
  if (report_.first_shown_ns == 0) {
    report_.first_shown_ns = now_ns;
    report_.first_shown_time = time;
  }
  report_.last_shown_time = time;
  report_.delay = moment_.known ? std::max(world_time(now_ns) - time, 0.0) : 0.0;
  return between;
}

void SnapshotMaker::make_film(bool to_the_end) {
  while (const std::optional<Between> between = next_of_film(to_the_end)) film_.push(blend(*between));
}

void SnapshotMaker::make_feedback() {
  const std::int64_t now_ns = steady_now_ns();
  if (now_ns < feedback_due_ns_) return;
  feedback_due_ns_ = now_ns + kFeedbackGap_ns;
  auto bytes = std::make_shared<const std::vector<std::uint8_t>>(wire::datagram(decoders_.feedback()));
  const std::lock_guard lock(inbox_mutex_);
  if (feedback_.size() < 4) feedback_.push_back(std::move(bytes));
}

}  // namespace slosh
