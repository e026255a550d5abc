#include "host/server/snapshot_coder.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "net/clock.h"

namespace slosh {
namespace {

// Blocks mended for one peer in one frame at most; what is left is asked for again.
constexpr std::uint32_t kMaxMended = 4096;
constexpr std::size_t kMaxMendingPeers = 256;
constexpr double kFreshEnough = 0.3;  // simulated s: an epoch as young as this need not be followed
constexpr std::size_t kBehind = 2;    // snapshots that may wait before one is left out
constexpr double kStanding = 0.25;    // s without a new snapshot after which the world stands
constexpr double kShownAgain = 0.1;   // s between two showings then

}  // namespace

SnapshotCoder::SnapshotCoder(double spacing, std::uint32_t run) : spacing_(spacing), run_(run) {}

void SnapshotCoder::see(const Snapshot& snapshot, std::uint32_t newest_run) {
  if (last_tick_ && snapshot.rigid.tick <= *last_tick_ && newest_run > run_) {
    run_ = newest_run;
    last_key_.fill(-1e9);
  }
  last_tick_ = snapshot.rigid.tick;
}

void SnapshotCoder::code(const Snapshot& snapshot, SnapshotOrder order, std::vector<CodedSnapshot>& out,
                         bool again) {
  const std::int64_t begin = steady_now_ns();
  for (MendOrder& wish : order.mends) {
    const std::pair key{wish.peer, wish.tier};
    if (mending_.size() < kMaxMendingPeers || mending_.contains(key)) mending_[key] = {std::move(wish), 2};
  }
  for (int tier = 0; tier < kTierCount; ++tier) {
    const auto i = static_cast<std::size_t>(tier);
    const bool first = order.watched[i] && !was_watched_[i];
    was_watched_[i] = order.watched[i];
    // An encoder that nobody watches rests, but stays: its epochs must go on rising.
    if (!order.watched[i]) continue;
    if (!again && count_ % kTiers[i].every != 0 && !order.fresh[i] && !first) continue;
    if (!encoders_[i]) {
      CodecOptions options;
      options.stream = static_cast<std::uint8_t>(tier);
      options.tolerance = kTiers[i].tolerance;
      options.spacing = spacing_;
      options.shell_only = kTiers[i].shell_only;
      encoders_[i].emplace(options);
    }
    const bool young = snapshot.rigid.time - last_key_[i] < kFreshEnough;
    CodedSnapshot coded;
    coded.tier = tier;
    coded.frame = encoders_[i]->encode(snapshot, run_, first || (order.fresh[i] && !young));
    if (coded.frame.key) last_key_[i] = snapshot.rigid.time;
    mend(tier, coded.frame, coded);
    out.push_back(std::move(coded));
  }
  if (!again) count_ += 1;
  std::erase_if(mending_, [&](const auto& entry) {
    return entry.second.frames_left <= 0 || !order.watched[static_cast<std::size_t>(entry.first.second)];
  });
  seconds_ += to_seconds(steady_now_ns() - begin);
}

void SnapshotCoder::mend(int tier, const EncodedFrame& frame, CodedSnapshot& out) {
  for (auto& [key, mending] : mending_) {
    if (key.second != tier) continue;
    const MendOrder& wish = mending.order;
    // A key frame mends everybody, and block numbers of another epoch mean other particles.
    const bool passed = frame.key || (!wish.all && wish.epoch != frame.epoch);
    mending.frames_left = passed ? 0 : mending.frames_left - 1;
    if (passed) continue;
    std::vector<wire::BlockRange> blocks;
    std::uint32_t room = kMaxMended;
    const auto add = [&](std::uint32_t first, std::uint32_t count) {
      if (first >= frame.blocks || room == 0) return;
      count = std::min({count, frame.blocks - first, room});
      room -= count;
      blocks.push_back({first, count});
    };
    if (wish.all) {
      add(0, frame.blocks);
    } else {
      for (const wire::BlockRange& range : wish.blocks) add(range.first, range.count);
    }
    pieces_.clear();
    encoders_[static_cast<std::size_t>(tier)]->mend(blocks, pieces_);
    if (!pieces_.empty()) out.mended.emplace_back(key.first, pieces_);
  }
}

SnapshotThread::SnapshotThread(SnapshotQueue& snapshots, SnapshotDesk& desk, SnapshotDemand& demand,
                               double spacing, std::uint32_t run, std::function<void()> wake)
    : snapshots_(snapshots), desk_(desk), demand_(demand), coder_(spacing, run), wake_(std::move(wake)) {
  thread_ = std::thread([this] { this->run(); });
}

SnapshotThread::~SnapshotThread() {
  if (thread_.joinable()) thread_.join();
}

void SnapshotThread::run() {
  SnapshotPointer newest;
  std::int64_t new_ns = 0;
  std::int64_t coded_ns = 0;
  std::vector<CodedSnapshot> coded;
  while (!snapshots_.finished()) {
    const bool watched = desk_.watched();
    demand_.want(watched);
    if (!watched) newest.reset();  // it would be an old one by the time that somebody looks
    SnapshotPointer snapshot = snapshots_.pop(std::chrono::milliseconds(watched ? 50 : 10));
    const std::int64_t now = steady_now_ns();
    const bool again = !snapshot;
    if (again) {
      if (!newest || now - new_ns < to_nanoseconds(kStanding) || now - coded_ns < to_nanoseconds(kShownAgain))
        continue;
    } else {
      newest = std::move(snapshot);
      new_ns = now;
      coder_.see(*newest, demand_.run());
      if (snapshots_.waiting() > kBehind) continue;
    }
    coded_ns = now;
    coded.clear();
    coder_.code(*newest, desk_.take_order(), coded, again);
    seconds_.store(coder_.seconds(), std::memory_order_relaxed);
    if (coded.empty()) continue;
    desk_.deliver(std::move(coded));
    wake_();
  }
}

}  // namespace slosh
