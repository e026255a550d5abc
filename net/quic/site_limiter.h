// How many handshakes one site may begin.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <unordered_map>

namespace slosh::quic {

/// A bucket of tokens a site, each filling at `rate` a s up to two seconds' worth. Remembers a bounded
/// number of sites.
class SiteLimiter {
 public:
  explicit SiteLimiter(double rate) : rate_(rate), most_(std::max(1.0, 2.0 * rate)) {}

  bool admit(const std::string& site, std::int64_t now) {
    if (sites_.size() >= kSites) forget(now);
    if (sites_.size() >= kSites && !sites_.contains(site)) return false;
    const auto [it, fresh] = sites_.try_emplace(site, Bucket{most_, now});
    Bucket& bucket = it->second;
    bucket.tokens = filled(bucket, now);
    bucket.at = now;
    if (bucket.tokens < 1.0) return false;
    bucket.tokens -= 1.0;
    return true;
  }

 private:
  static constexpr std::size_t kSites = 4096;
  struct Bucket {
    double tokens;
    std::int64_t at;
  };
  double filled(const Bucket& bucket, std::int64_t now) const {
    return std::min(most_, bucket.tokens + rate_ * 1e-9 * static_cast<double>(now - bucket.at));
  }
  void forget(std::int64_t now) {
    std::erase_if(sites_, [&](const auto& entry) { return filled(entry.second, now) >= most_; });
  }

  double rate_;
  double most_;
  std::unordered_map<std::string, Bucket> sites_;
};

}  // namespace slosh::quic
