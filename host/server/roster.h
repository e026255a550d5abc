// Who is here and who holds what.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "host/server/link_role.h"
#include "host/server/outcome.h"
#include "net/quic/endpoint.h"
#include "net/wire/messages.h"

namespace slosh {

/// s that a seat and its grips wait for somebody who lost contact.
constexpr double kSeatKept = 60.0;

/// One person, known by a key.
struct Seat {
  std::uint32_t number = 0;  ///< Roster's `peer`
  KeyFingerprint key{};
  std::string name;   ///< no two look alike
  std::string looks;  ///< name_skeleton(name)
  LinkRole role = LinkRole::kWatch;
  std::vector<std::uint32_t> grips;  ///< held, or waiting for the person to come back
  std::string link;                  ///< id of the link that it came by
  bool connected = true;
  bool left = false;               ///< went with a Bye: the grips are free for others meanwhile
  std::int64_t away_since_ns = 0;  ///< steady clock
};

/// A seat in a checkpoint; all are away when it is read back.
struct SeatRecord {
  std::uint32_t number = 0;
  KeyFingerprint key{};
  std::string name;
  LinkRole role = LinkRole::kWatch;
  std::vector<std::uint32_t> grips;
  std::string link;
};
template <class V>
void visit(V& v, SeatRecord& m) {
  v.natural("number", m.number, 0, wire::kMaxPeers - 1);
  v.array("key", m.key);
  v.text("name", m.name, wire::kMaxName);
  v.choice("role", m.role, kLinkRoleNames);
  v.list("grips", m.grips, wire::kMaxGrips,
         [](auto& each, std::uint32_t& grip) { each.natural("grip", grip, 0, wire::kMaxGrips - 1); });
  v.text("link", m.link, 16);
}

struct RosterLimits {
  std::size_t participants = 8;
  std::size_t spectators = 150;
};

/// One thread; knows no clock.
class SeatTable {
 public:
  SeatTable(std::vector<std::string> grip_names, RosterLimits limits)
      : grip_names_(std::move(grip_names)), limits_(limits) {}

  struct Arrival {
    Seat* seat = nullptr;   ///< null: full, `text` says so
    bool restored = false;  ///< the seat was kept, with its grips
    std::string text;
  };
  /// Would arrive() let this key in? Empty, or why not, in words. The limits hold for a key that has a seat
  /// too: it finds room while its seat in that role is taken or kept, and else when there is room for
  /// anybody.
  std::string full(const KeyFingerprint& key, LinkRole role);
  /// Somebody comes in. `wish` is the name they would like, empty = one is found; it is cleaned, and numbered
  /// where it looks like another's or like one of `reserved` (skeletons). A key that has a seat gets it back,
  /// its grips too unless its role no longer allows any or, after a Bye, another took them.
  Arrival arrive(const KeyFingerprint& key, LinkRole role, const std::string& wish, const std::string& link,
                 const std::vector<std::string>& reserved = {});
  void lose(Seat& seat, std::int64_t now_ns);   ///< contact is lost: all is kept for kSeatKept
  void leave(Seat& seat, std::int64_t now_ns);  ///< said Bye
  /// Removes who stayed away longer than kSeatKept; returns them.
  std::vector<Seat> expire(std::int64_t now_ns);
  void remove(std::uint32_t number);

  Outcome take(Seat& seat, std::uint32_t grip);
  Outcome release(Seat& seat, std::uint32_t grip);

  /// Who holds this grip or for whom it is kept; null = nobody. One who left does not keep it.
  const Seat* holder(std::uint32_t grip) const;
  Seat* by_key(const KeyFingerprint& key);
  Seat* by_number(std::uint32_t number);
  Seat* by_name(const std::string& name);  ///< also typed in letters that look the same
  const std::map<std::uint32_t, Seat>& seats() const { return seats_; }
  const std::vector<std::string>& grip_names() const { return grip_names_; }
  std::string grip_name(std::uint32_t grip) const;

  wire::Roster message() const;
  std::vector<SeatRecord> records() const;
  /// All away since `now_ns`. What does not fit this scene or contradicts itself is left out.
  void restore(const std::vector<SeatRecord>& records, std::int64_t now_ns);

 private:
  std::string free_name(const std::string& wish, const std::vector<std::string>& reserved) const;
  std::size_t limit_of(LinkRole role) const;
  /// Seats of those who may hold, as this role may, or else may not, that are taken, or kept for who lost
  /// contact with hands.
  std::size_t taken(LinkRole role, const Seat* but) const;
  bool make_room(LinkRole role);

  std::vector<std::string> grip_names_;
  RosterLimits limits_;
  std::map<std::uint32_t, Seat> seats_;  // by number: a Seat stays where it is while it exists
};

}  // namespace slosh
