// Who may not come in for a while, whatever link they have.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "net/quic/endpoint.h"
#include "net/wire/messages.h"

namespace slosh {

constexpr std::size_t kMaxBans = 256;

/// By key: who makes another key is another person, and needs a link that lets strangers in.
struct BanRecord {
  KeyFingerprint key{};
  std::string name;           ///< that they had
  std::int64_t until_ns = 0;  ///< Unix time
};
template <class V>
void visit(V& v, BanRecord& m) {
  v.array("key", m.key);
  v.text("name", m.name, wire::kMaxName);
  v.stamp("until_ns", m.until_ns);
}

/// One thread; knows no clock.
class BanList {
 public:
  /// A key has one ban, the newest. Beyond kMaxBans the one that ends first goes.
  void add(const KeyFingerprint& key, const std::string& name, std::int64_t until_ns);
  /// `looks`: name_skeleton of the name. False when nobody of that name is banned.
  bool lift(const std::string& looks);
  /// Until when, Unix ns; 0 = not banned.
  std::int64_t until(const KeyFingerprint& key, std::int64_t unix_ns) const;
  /// Forgets what is over. True when something was.
  bool expire(std::int64_t unix_ns);
  const std::vector<BanRecord>& bans() const { return bans_; }
  void restore(std::vector<BanRecord> bans) { bans_ = std::move(bans); }

 private:
  std::vector<BanRecord> bans_;
};

}  // namespace slosh
