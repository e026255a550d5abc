#include "host/server/links.h"

#include <algorithm>

#include "net/random.h"
#include "net/text/name.h"

namespace slosh {
namespace {

bool same(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  // Always through to the end: the time taken must not tell how much of a guess was right.
  volatile std::uint8_t difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference = static_cast<std::uint8_t>(difference | (a[i] ^ b[i]));
  return difference == 0;
}

bool knows(const LinkRecord& link, const KeyFingerprint& key) {
  return std::find(link.users.begin(), link.users.end(), key) != link.users.end();
}

// Two open syllables: nothing that sounds alike over a telephone.
std::string random_id() {
  constexpr std::string_view kConsonants = "bdfgklmnprstvz";
  constexpr std::string_view kVowels = "aeiou";
  std::array<std::uint8_t, 4> raw{};
  fill_random(raw);
  std::string id;
  for (int i = 0; i < 2; ++i) {
    id += kConsonants[raw[static_cast<std::size_t>(2 * i)] % kConsonants.size()];
    id += kVowels[raw[static_cast<std::size_t>(2 * i + 1)] % kVowels.size()];
  }
  return id;
}

}  // namespace

const LinkRecord* LinkRegistry::create(LinkRole role, const std::string& name, std::int64_t unix_ns,
                                       std::int64_t lifetime_ns,
                                       const std::function<bool(const std::string&)>& in_use) {
  if (links_.size() >= kMaxLinks) {
    const auto dead = [&](const LinkRecord& link) {
      if (in_use && in_use(link.id)) return false;
      return link.revoked || (link.expires_ns != 0 && link.expires_ns <= unix_ns);
    };
    links_.erase(std::remove_if(links_.begin(), links_.end(), dead), links_.end());
    if (links_.size() >= kMaxLinks) return nullptr;
  }
  LinkRecord link;
  do link.id = random_id();
  while (find(link.id));
  fill_random(link.token);
  link.role = role;
  link.name = name;
  link.created_ns = unix_ns;
  link.expires_ns = lifetime_ns > 0 ? unix_ns + lifetime_ns : 0;
  links_.push_back(std::move(link));
  return &links_.back();
}

LinkVerdict LinkRegistry::check(const wire::Token& token, const KeyFingerprint& key,
                                std::int64_t unix_ns) const {
  const LinkRecord* found = nullptr;
  for (const LinkRecord& link : links_) {
    if (same(link.token, token)) found = &link;
  }
  const LinkVerdict stranger{nullptr, wire::RefusalCode::kBadToken,
                             "this link does not open this world. Ask the host for a new one"};
  if (!found) return stranger;
  const bool known = knows(*found, key);
  if (found->revoked) {
    if (!known) return stranger;
    return {nullptr, wire::RefusalCode::kRevoked, "the host has revoked this link. Ask for a new one"};
  }
  if (found->expires_ns != 0 && found->expires_ns <= unix_ns) {
    if (!known) return stranger;
    return {nullptr, wire::RefusalCode::kExpired, "this link has expired. Ask the host for a new one"};
  }
  if (!found->name.empty() && !found->users.empty() && !known) {
    return {nullptr, wire::RefusalCode::kBadToken,
            "this link was for one person and is in use. Ask the host for one of your own"};
  }
  return {found, {}, {}};
}

void LinkRegistry::note_use(const std::string& id, const KeyFingerprint& key) {
  LinkRecord* link = find_mutable(id);
  if (!link || knows(*link, key)) return;
  if (link->users.size() >= kMaxLinkUsers) link->users.erase(link->users.begin());
  link->users.push_back(key);
}

std::vector<std::string> LinkRegistry::reserved_names(const std::string& id, std::int64_t unix_ns) {
  if (looks_.size() > 4 * kMaxLinks) looks_.clear();
  std::vector<std::string> names;
  for (const LinkRecord& link : links_) {
    const bool over =
        link.revoked || (link.expires_ns != 0 && link.expires_ns <= unix_ns && link.users.empty());
    if (link.name.empty() || link.id == id || over) continue;
    const auto [found, fresh] = looks_.try_emplace(link.name);
    if (fresh) found->second = name_skeleton(link.name);
    names.push_back(found->second);
  }
  return names;
}

bool LinkRegistry::revoke(std::string_view id) {
  LinkRecord* link = find_mutable(id);
  if (link) link->revoked = true;
  return link != nullptr;
}

bool LinkRegistry::set_expiry(std::string_view id, std::int64_t expires_ns) {
  LinkRecord* link = find_mutable(id);
  if (link) link->expires_ns = expires_ns;
  return link != nullptr;
}

bool LinkRegistry::set_role(std::string_view id, LinkRole role) {
  LinkRecord* link = find_mutable(id);
  if (link) link->role = role;
  return link != nullptr;
}

const LinkRecord* LinkRegistry::find(std::string_view id) const {
  for (const LinkRecord& link : links_) {
    if (link.id == id) return &link;
  }
  return nullptr;
}

LinkRecord* LinkRegistry::find_mutable(std::string_view id) {
  return const_cast<LinkRecord*>(find(id));
}

}  // namespace slosh
