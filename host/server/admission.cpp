#include "host/server/admission.h"

#include <algorithm>

#include "net/clock.h"
#include "net/site.h"

namespace slosh {

std::optional<ConnectionId> Admission::oldest_stranger(const std::string& site) const {
  for (const auto& [id, guest] : guests_) {
    if (!guest.in && !guest.known && guest.site == site) return id;
  }
  return std::nullopt;
}

Admission::Verdict Admission::arrive(ConnectionId connection, const KeyFingerprint& key,
                                     const std::string& address, bool known, std::int64_t now_ns) {
  Verdict verdict;
  const std::string site = site_of(address);
  if (known) {
    // A key proves itself in the handshake: who waits by it already is the same person.
    for (const auto& [id, guest] : guests_) {
      if (guest.known && !guest.in && guest.key == key) verdict.goes = id;
    }
  } else {
    const Site& here = sites_[site];
    if (here.all >= limits_.a_site) {
      verdict.goes = oldest_stranger(site);
      if (!verdict.goes) return verdict;
    } else if (strangers_ >= limits_.strangers) {
      const auto most = std::max_element(
          sites_.begin(), sites_.end(),
          [](const auto& left, const auto& right) { return left.second.strangers < right.second.strangers; });
      verdict.goes = oldest_stranger(most->first);
    }
  }
  if (verdict.goes) forget(*verdict.goes);
  verdict.enters = true;
  Site& here = sites_[site];
  here.all += 1;
  here.strangers += known ? 0 : 1;
  strangers_ += known ? 0 : 1;
  guests_[connection] = {key, site, now_ns, known, false};
  return verdict;
}

void Admission::admit(ConnectionId connection) {
  const auto found = guests_.find(connection);
  if (found == guests_.end() || found->second.in) return;
  found->second.in = true;
  if (found->second.known) return;
  sites_[found->second.site].strangers -= 1;
  strangers_ -= 1;
}

void Admission::forget(ConnectionId connection) {
  const auto found = guests_.find(connection);
  if (found == guests_.end()) return;
  const Guest& guest = found->second;
  const auto site = sites_.find(guest.site);
  const bool stranger = !guest.in && !guest.known;
  strangers_ -= stranger ? 1 : 0;
  site->second.strangers -= stranger ? 1 : 0;
  site->second.all -= 1;
  if (site->second.all == 0) sites_.erase(site);
  guests_.erase(found);
}

std::vector<ConnectionId> Admission::late(std::int64_t now_ns) const {
  std::vector<ConnectionId> late;
  for (const auto& [id, guest] : guests_) {
    if (!guest.in && now_ns - guest.since_ns > to_nanoseconds(limits_.hello_patience)) late.push_back(id);
  }
  return late;
}

}  // namespace slosh
