// The roster as differences: what one side writes and the other applies.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "net/wire/messages.h"

namespace slosh::wire {

/// Brings `peers` to what they are after the change; they stay in the order of their numbers.
void apply(const RosterChange& change, std::vector<RosterEntry>& peers);

/// What a crowd of readers has been told, so that each needs only what is new. Readers begin with the whole
/// roster at different times; applying the same changes leads all of them to the same one.
class RosterTold {
 public:
  /// Somebody is given `now` whole: others may not know all of it yet.
  void whole(const Roster& now);
  /// What to tell all; `now` is told then.
  RosterChange change(const Roster& now);

 private:
  /// Empty: some have been told, not all, or not the same.
  std::map<std::uint32_t, std::optional<RosterEntry>> told_;
};

}  // namespace slosh::wire
