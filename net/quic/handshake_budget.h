// How many handshakes may begin: by one site, and by all strangers together.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <unordered_map>

namespace slosh::quic {

/// Buckets of tokens. A handshake costs about a millisecond of the thread that passes poses on, so that all
/// sites together have a budget, and those who take much of it leave the rest alone:
///
/// - every site has a bucket that fills at `per_site` a s, up to two seconds' worth;
/// - a site that began few handshakes lately draws on one half of `in_all`, one that began many on the other;
/// - a site that somebody was admitted from within the last hour draws on neither, so that who lost contact
///   comes back however many knock.
///
/// Reads no clock and remembers a bounded number of sites.
class HandshakeBudget {
 public:
  HandshakeBudget(double per_site, double in_all)
      : per_site_(per_site), most_(std::max(1.0, 2.0 * per_site)), half_(0.5 * in_all) {}

  /// Whether one more handshake of `site` may begin.
  bool take(const std::string& site, std::int64_t now) {
    auto found = sites_.find(site);
    if (found == sites_.end()) {
      if (sites_.size() >= kSites) forget(now);
      // More sites than anybody honest has: they share what those share that began little.
      if (sites_.size() >= kSites) return take(few_, now);
      found = sites_.emplace(site, Site{most_, now, 0}).first;
    }
    Site& own = found->second;
    own.tokens = filled(own, now);
    own.at = now;
    if (own.tokens < 1.0) return false;
    const bool few = own.tokens > most_ - std::min(kFew, 0.5 * most_);
    own.tokens -= 1.0;  // also when all together have begun enough: who knocks on stays among the many
    return own.trusted_until > now || take(few ? few_ : many_, now);
  }

  /// Somebody at `site` was let in: what they took is given back.
  void admitted(const std::string& site, std::int64_t now) {
    const auto [found, fresh] = sites_.try_emplace(site, Site{most_, now, 0});
    Site& own = found->second;
    own.tokens = std::min(most_, filled(own, now) + 1.0);
    own.at = now;
    own.trusted_until = now + kTrust;
  }

  std::size_t sites() const { return sites_.size(); }

 private:
  static constexpr std::size_t kSites = 4096;
  static constexpr double kFew = 4.0;                       // handshakes that anybody may need at once
  static constexpr double kAtOnce = 0.25;                   // s of a half that may begin at once
  static constexpr std::int64_t kTrust = 3600'000'000'000;  // ns

  struct Site {
    double tokens;
    std::int64_t at;
    std::int64_t trusted_until;
  };
  struct Shared {
    double tokens = 1e9;  // cut to the most at the first use
    std::int64_t at = 0;
  };

  bool take(Shared& shared, std::int64_t now) {
    const double most = std::max(1.0, kAtOnce * half_);
    shared.tokens = std::min(most, shared.tokens + half_ * 1e-9 * static_cast<double>(now - shared.at));
    shared.at = now;
    if (shared.tokens < 1.0) return false;
    shared.tokens -= 1.0;
    return true;
  }
  double filled(const Site& site, std::int64_t now) const {
    return std::min(most_, site.tokens + per_site_ * 1e-9 * static_cast<double>(now - site.at));
  }
  void forget(std::int64_t now) {
    std::erase_if(sites_, [&](const auto& entry) {
      return entry.second.trusted_until <= now && filled(entry.second, now) >= most_;
    });
  }

  double per_site_;
  double most_;
  double half_;
  Shared few_;
  Shared many_;
  std::unordered_map<std::string, Site> sites_;
};

}  // namespace slosh::quic
