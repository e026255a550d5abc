#include "host/server/picture_desk.h"

#include <algorithm>
#include <iterator>

namespace slosh {
namespace {

constexpr std::size_t kMostWaiting = 24;  // coded pictures that nobody collected

}  // namespace

void PictureDesk::order(PictureOrder order) {
  const std::lock_guard lock(mutex_);
  order_.watched = order.watched;
  for (std::size_t i = 0; i < order.fresh.size(); ++i) order_.fresh[i] = order_.fresh[i] || order.fresh[i];
  std::move(order.mends.begin(), order.mends.end(), std::back_inserter(order_.mends));
}

std::vector<CodedPicture> PictureDesk::collect() {
  const std::lock_guard lock(mutex_);
  return std::exchange(coded_, {});
}

PictureOrder PictureDesk::take_order() {
  const std::lock_guard lock(mutex_);
  PictureOrder order = order_;
  order_.fresh.fill(false);
  order_.mends.clear();
  return order;
}

bool PictureDesk::watched() const {
  const std::lock_guard lock(mutex_);
  return std::any_of(order_.watched.begin(), order_.watched.end(), [](bool tier) { return tier; });
}

void PictureDesk::deliver(std::vector<CodedPicture> pictures) {
  const std::lock_guard lock(mutex_);
  std::move(pictures.begin(), pictures.end(), std::back_inserter(coded_));
  if (coded_.size() > kMostWaiting)
    coded_.erase(coded_.begin(), coded_.end() - static_cast<std::ptrdiff_t>(kMostWaiting));
}

}  // namespace slosh
