#include "host/server/bans.h"

#include <algorithm>

#include "net/text/name.h"

namespace slosh {

void BanList::add(const KeyFingerprint& key, const std::string& name, std::int64_t until_ns) {
  std::erase_if(bans_, [&](const BanRecord& ban) { return ban.key == key; });
  bans_.push_back({key, name, until_ns});
  if (bans_.size() <= kMaxBans) return;
  bans_.erase(std::min_element(bans_.begin(), bans_.end(), [](const BanRecord& left, const BanRecord& right) {
    return left.until_ns < right.until_ns;
  }));
}

bool BanList::lift(const std::string& looks) {
  return std::erase_if(bans_, [&](const BanRecord& ban) { return name_skeleton(ban.name) == looks; }) > 0;
}

std::int64_t BanList::until(const KeyFingerprint& key, std::int64_t unix_ns) const {
  for (const BanRecord& ban : bans_) {
    if (ban.key == key && ban.until_ns > unix_ns) return ban.until_ns;
  }
  return 0;
}

bool BanList::expire(std::int64_t unix_ns) {
  return std::erase_if(bans_, [&](const BanRecord& ban) { return ban.until_ns <= unix_ns; }) > 0;
}

}  // namespace slosh
