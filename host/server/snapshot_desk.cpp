#include "host/server/snapshot_desk.h"

#include <algorithm>
#include <iterator>

namespace slosh {
namespace {

constexpr std::size_t kMaxWaiting = 24;  // coded snapshots that nobody collected

}  // namespace

void SnapshotDesk::order(SnapshotOrder order) {
  const std::lock_guard lock(mutex_);
  order_.watched = order.watched;
  for (std::size_t i = 0; i < order.fresh.size(); ++i) order_.fresh[i] = order_.fresh[i] || order.fresh[i];
  std::move(order.mends.begin(), order.mends.end(), std::back_inserter(order_.mends));
}

std::vector<CodedSnapshot> SnapshotDesk::collect() {
  const std::lock_guard lock(mutex_);
  return std::exchange(coded_, {});
}

SnapshotOrder SnapshotDesk::take_order() {
  const std::lock_guard lock(mutex_);
  SnapshotOrder order = order_;
  order_.fresh.fill(false);
  order_.mends.clear();
  return order;
}

bool SnapshotDesk::watched() const {
  const std::lock_guard lock(mutex_);
  return std::any_of(order_.watched.begin(), order_.watched.end(), [](bool tier) { return tier; });
}

void SnapshotDesk::deliver(std::vector<CodedSnapshot> snapshots) {
  const std::lock_guard lock(mutex_);
  std::move(snapshots.begin(), snapshots.end(), std::back_inserter(coded_));
  if (coded_.size() > kMaxWaiting)
    coded_.erase(coded_.begin(), coded_.end() - static_cast<std::ptrdiff_t>(kMaxWaiting));
}

}  // namespace slosh
