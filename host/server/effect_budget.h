// How much guests may change of the world in a time, by what it does to everybody's hands.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "host/server/token_bucket.h"
#include "host/tap.h"
#include "net/quic/endpoint.h"
#include "net/wire/limits.h"

namespace slosh {

/// A change counts by its size: gravity from 0 to 2 counts twice what it does from 0 to 1, a slider that is
/// dragged there in a hundred steps as much as one step. Whoever comes again by the same key finds the same
/// budget. One thread; reads no clock.
class EffectBudget {
 public:
  EffectBudget();

  /// Takes what `command` comes to, in a world that is `now`, from the budget of `who` and from that of all
  /// guests. Empty; or, where one of the two has not enough, why not and when again, in words: then nothing
  /// is taken.
  std::string spend(const KeyFingerprint& who, const HostCommand& command, const HostState& now,
                    std::int64_t now_ns);

  /// Keys that are remembered: those whose budgets may not be full again.
  std::size_t remembered() const { return guests_.size(); }

 private:
  struct Guest {
    std::vector<TokenBucket> buckets;  // one a kind
    std::int64_t used_ns = 0;
  };
  struct Asked {
    double value = 0.0;
    std::int64_t at_ns = 0;
  };
  double size_of(const HostCommand& command, const HostState& now, std::int64_t now_ns) const;
  Guest& guest(const KeyFingerprint& who, std::int64_t now_ns);

  std::vector<TokenBucket> all_;
  std::map<KeyFingerprint, Guest> guests_;
  std::map<std::pair<HostAction, std::uint32_t>, Asked>
      asked_;  // the newest value, which the world may not have yet
};

}  // namespace slosh
