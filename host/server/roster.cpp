#include "host/server/roster.h"

#include <algorithm>

#include "net/clock.h"
#include "net/console_words.h"
#include "net/text/name.h"
#include "net/wire/text.h"

namespace slosh {
namespace {

void drop(std::vector<std::uint32_t>& grips, std::uint32_t grip) {
  grips.erase(std::remove(grips.begin(), grips.end(), grip), grips.end());
}

bool has(const std::vector<std::uint32_t>& grips, std::uint32_t grip) {
  return std::find(grips.begin(), grips.end(), grip) != grips.end();
}

}  // namespace

std::string SeatTable::free_name(const std::string& wish, const std::vector<std::string>& reserved) const {
  const auto taken = [&](const std::string& name) {
    const std::string looks = name_skeleton(name);
    return std::find(reserved.begin(), reserved.end(), looks) != reserved.end() ||
           std::any_of(seats_.begin(), seats_.end(),
                       [&](const auto& entry) { return entry.second.looks == looks; });
  };
  const std::string clean = clean_name(wish);
  if (!clean.empty() && !taken(clean)) return clean;
  const std::string base = clean.empty() ? "guest" : clean_name(wire::clean_text(clean, wire::kMaxName - 5));
  for (int i = clean.empty() ? 1 : 2;; ++i) {
    const std::string name = base + " " + std::to_string(i);
    if (!taken(name)) return name;
  }
}

std::size_t SeatTable::limit_of(LinkRole role) const {
  return may_hold(role) ? limits_.participants : limits_.spectators;
}

std::size_t SeatTable::taken(LinkRole role, const Seat* but) const {
  std::size_t taken = 0;
  for (const auto& [number, seat] : seats_) {
    const bool kept = may_hold(role) && !seat.left;
    taken += &seat != but && may_hold(seat.role) == may_hold(role) && (seat.connected || kept) ? 1 : 0;
  }
  return taken;
}

std::string SeatTable::full(const KeyFingerprint& key, LinkRole role) {
  if (taken(role, by_key(key)) < limit_of(role)) return {};
  return may_hold(role) ? "this world is full: no more hands find room. Try the link for watching"
                        : "this world is full: too many are watching. Try again later";
}

// Seats of people who are away must not keep others out: the one away longest goes, of hands only who left.
bool SeatTable::make_room(LinkRole role) {
  std::size_t of_role = 0;
  const Seat* oldest = nullptr;
  for (const auto& [number, seat] : seats_) {
    of_role += may_hold(seat.role) == may_hold(role) ? 1 : 0;
    if (seat.connected || (may_hold(seat.role) && !seat.left)) continue;
    if (!oldest || seat.away_since_ns < oldest->away_since_ns) oldest = &seat;
  }
  const std::size_t away_limit = limit_of(role) + 32;
  if ((of_role >= away_limit || seats_.size() >= wire::kMaxPeers) && oldest) {
    seats_.erase(oldest->number);
    return true;
  }
  return of_role < away_limit && seats_.size() < wire::kMaxPeers;
}

SeatTable::Arrival SeatTable::arrive(const KeyFingerprint& key, LinkRole role, const std::string& wish,
                                     const std::string& link, const std::vector<std::string>& reserved) {
  if (std::string problem = full(key, role); !problem.empty()) return {nullptr, false, std::move(problem)};
  if (Seat* seat = by_key(key)) {
    seat->link = link;
    seat->connected = true;
    seat->left = false;
    seat->role = role;
    if (!may_hold(role)) seat->grips.clear();
    return {seat, true, {}};
  }
  if (!make_room(role)) return {nullptr, false, "this world is full: too many come and go. Try again later"};
  Seat seat;
  while (seats_.contains(seat.number)) seat.number += 1;
  seat.key = key;
  seat.name = free_name(wish, reserved);
  seat.looks = name_skeleton(seat.name);
  seat.role = role;
  seat.link = link;
  const std::uint32_t number = seat.number;
  return {&seats_.emplace(number, std::move(seat)).first->second, false, {}};
}

void SeatTable::lose(Seat& seat, std::int64_t now_ns) {
  if (!seat.connected) return;
  seat.connected = false;
  seat.away_since_ns = now_ns;
}

void SeatTable::leave(Seat& seat, std::int64_t now_ns) {
  lose(seat, now_ns);
  seat.left = true;
}

std::vector<Seat> SeatTable::expire(std::int64_t now_ns) {
  std::vector<Seat> gone;
  for (auto at = seats_.begin(); at != seats_.end();) {
    if (!at->second.connected && now_ns - at->second.away_since_ns > to_nanoseconds(kSeatKept)) {
      gone.push_back(std::move(at->second));
      at = seats_.erase(at);
    } else {
      ++at;
    }
  }
  return gone;
}

void SeatTable::remove(std::uint32_t number) {
  seats_.erase(number);
}

Outcome SeatTable::take(Seat& seat, std::uint32_t grip) {
  if (!may_hold(seat.role)) return {false, "this link is for watching; taking hold needs the other one"};
  if (grip >= grip_names_.size()) return {false, no_grip_text(std::to_string(grip), grip_names_)};
  if (has(seat.grips, grip)) return {true, {}};
  if (const Seat* other = holder(grip)) {
    const std::string held = grip_name(grip) + " is held by " + other->name;
    return {false, other->connected ? held
                                    : grip_name(grip) + " is kept for " + other->name +
                                          ", who lost contact less than a minute ago"};
  }
  for (auto& [number, other] : seats_) drop(other.grips, grip);  // of those who left
  seat.grips.push_back(grip);
  std::sort(seat.grips.begin(), seat.grips.end());
  return {true, {}};
}

Outcome SeatTable::release(Seat& seat, std::uint32_t grip) {
  if (!has(seat.grips, grip)) return {false, "you do not hold " + grip_name(grip)};
  drop(seat.grips, grip);
  return {true, {}};
}

const Seat* SeatTable::holder(std::uint32_t grip) const {
  for (const auto& [number, seat] : seats_) {
    if (!seat.left && has(seat.grips, grip)) return &seat;
  }
  return nullptr;
}

Seat* SeatTable::by_key(const KeyFingerprint& key) {
  for (auto& [number, seat] : seats_) {
    if (seat.key == key) return &seat;
  }
  return nullptr;
}

Seat* SeatTable::by_number(std::uint32_t number) {
  const auto found = seats_.find(number);
  return found == seats_.end() ? nullptr : &found->second;
}

Seat* SeatTable::by_name(const std::string& name) {
  const std::string looks = name_skeleton(name);
  for (auto& [number, seat] : seats_) {
    if (seat.name == name || (!looks.empty() && seat.looks == looks)) return &seat;
  }
  return nullptr;
}

std::string SeatTable::grip_name(std::uint32_t grip) const {
  if (grip < grip_names_.size() && !grip_names_[grip].empty()) return "grip '" + grip_names_[grip] + "'";
  return "grip " + std::to_string(grip);
}

wire::Roster SeatTable::message() const {
  wire::Roster roster;
  roster.peers.reserve(seats_.size());
  for (const auto& [number, seat] : seats_) {
    if (seat.left) continue;
    roster.peers.push_back({number, seat.name, wire_role(seat.role), seat.connected, seat.grips});
  }
  return roster;
}

std::vector<SeatRecord> SeatTable::records() const {
  std::vector<SeatRecord> records;
  for (const auto& [number, seat] : seats_) {
    if (seat.left) continue;
    records.push_back({number, seat.key, seat.name, seat.role, seat.grips, seat.link});
  }
  return records;
}

void SeatTable::restore(const std::vector<SeatRecord>& records, std::int64_t now_ns) {
  seats_.clear();
  for (const SeatRecord& record : records) {
    if (seats_.contains(record.number) || by_key(record.key) || by_name(record.name)) continue;
    Seat seat;
    seat.number = record.number;
    seat.key = record.key;
    seat.name = record.name;
    seat.looks = name_skeleton(record.name);
    seat.role = record.role;
    seat.link = record.link;
    seat.connected = false;
    seat.away_since_ns = now_ns;
    for (const std::uint32_t grip : record.grips) {
      if (may_hold(record.role) && grip < grip_names_.size() && !holder(grip) && !has(seat.grips, grip)) {
        seat.grips.push_back(grip);
      }
    }
    seats_.emplace(seat.number, std::move(seat));
  }
}

}  // namespace slosh
