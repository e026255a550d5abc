#include "net/wire/roster_change.h"

#include <algorithm>

namespace slosh::wire {

void apply(const RosterChange& change, std::vector<RosterEntry>& peers) {
  const auto at = [&](std::uint32_t number) {
    return std::lower_bound(peers.begin(), peers.end(), number,
                            [](const RosterEntry& entry, std::uint32_t n) { return entry.peer < n; });
  };
  // A host's roster is in order; whoever sends another must not make us wrong.
  std::sort(peers.begin(), peers.end(),
            [](const RosterEntry& left, const RosterEntry& right) { return left.peer < right.peer; });
  for (const std::uint32_t number : change.gone) {
    const auto found = at(number);
    if (found != peers.end() && found->peer == number) peers.erase(found);
  }
  for (const RosterEntry& entry : change.changed) {
    const auto found = at(entry.peer);
    if (found != peers.end() && found->peer == entry.peer)
      *found = entry;
    else
      peers.insert(found, entry);
  }
}

void RosterTold::whole(const Roster& now) {
  for (const RosterEntry& entry : now.peers) {
    const auto [found, fresh] = told_.try_emplace(entry.peer, std::nullopt);
    if (!fresh && found->second && *found->second != entry) found->second.reset();
  }
}

RosterChange RosterTold::change(const Roster& now) {
  RosterChange change;
  std::map<std::uint32_t, std::optional<RosterEntry>> next;
  for (const RosterEntry& entry : now.peers) {
    const auto found = told_.find(entry.peer);
    if (found == told_.end() || !found->second || *found->second != entry) change.changed.push_back(entry);
    next[entry.peer] = entry;
  }
  for (const auto& [number, entry] : told_) {
    if (!next.contains(number)) change.gone.push_back(number);
  }
  told_ = std::move(next);
  return change;
}

}  // namespace slosh::wire
