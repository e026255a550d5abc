// The links of a host: who may come in, as what, until when.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/server/link_role.h"
#include "net/quic/endpoint.h"
#include "net/wire/messages.h"

namespace slosh {

constexpr std::size_t kMaxLinks = 256;
constexpr std::size_t kMaxLinkUsers = 1024;  ///< keys that a link remembers

/// A link that has expired admits nobody new; who came by it stays, and may come back while the seat is kept.
/// One that was revoked ends for everybody. Times are ns of Unix time, so that they mean the same after a
/// restart of the host; 0 = never.
struct LinkRecord {
  std::string id;  ///< short, to be spoken: "bako"
  wire::Token token{};
  LinkRole role = LinkRole::kWatch;
  std::string name;  ///< whom it is for; empty = anybody, any number
  std::int64_t created_ns = 0;
  std::int64_t expires_ns = 0;
  bool revoked = false;
  std::vector<KeyFingerprint> users;  ///< keys that came in by it, oldest first
};

/// 32 bytes as a field.
template <class V>
void visit_key(V& v, const char* name, KeyFingerprint& key) {
  v.array(name, key);
}

template <class V>
void visit(V& v, LinkRecord& m) {
  v.text("id", m.id, 16);
  v.array("token", m.token);
  v.choice("role", m.role, kLinkRoleNames);
  v.text("name", m.name, wire::kMaxName);
  v.stamp("created_ns", m.created_ns);
  v.stamp("expires_ns", m.expires_ns);
  v.flag("revoked", m.revoked);
  v.list("users", m.users, kMaxLinkUsers,
         [](auto& each, KeyFingerprint& key) { visit_key(each, "key", key); });
}

/// What a token is worth to the one who shows it.
struct LinkVerdict {
  const LinkRecord* link = nullptr;  ///< null: refused
  wire::RefusalCode code = wire::RefusalCode::kBadToken;
  std::string text;  ///< why refused, for people
};

/// Knows no clock: `unix_ns` is now. One thread.
class LinkRegistry {
 public:
  /// A new link with a token from the kernel's random source. `lifetime_ns` 0 = for ever. Null when there are
  /// kMaxLinks; revoked and expired ones make room, but for those that somebody here came by (`in_use`, by
  /// id).
  const LinkRecord* create(LinkRole role, const std::string& name, std::int64_t unix_ns,
                           std::int64_t lifetime_ns = 0,
                           const std::function<bool(const std::string&)>& in_use = {});

  /// Is `key` let in by `token`? A personal link belongs to the first key that comes by it. That a link was
  /// revoked or has expired is told only to a key that came in by it. Takes the same time whichever
  /// characters of the token are wrong.
  LinkVerdict check(const wire::Token& token, const KeyFingerprint& key, std::int64_t unix_ns) const;
  /// Remembers that `key` came in; after check().
  void note_use(const std::string& id, const KeyFingerprint& key);

  /// False when there is no link of that id.
  bool revoke(std::string_view id);
  bool set_expiry(std::string_view id, std::int64_t expires_ns);
  bool set_role(std::string_view id, LinkRole role);

  /// What the names look like (name_skeleton) that other links than `id`, which still work, were made for:
  /// nobody who comes by another may have one of them.
  std::vector<std::string> reserved_names(const std::string& id, std::int64_t unix_ns);

  const LinkRecord* find(std::string_view id) const;
  const std::vector<LinkRecord>& links() const { return links_; }
  void restore(std::vector<LinkRecord> links) { links_ = std::move(links); }

 private:
  LinkRecord* find_mutable(std::string_view id);
  std::vector<LinkRecord> links_;
  std::map<std::string, std::string> looks_;  // of names of links; skeletons take long
};

}  // namespace slosh
