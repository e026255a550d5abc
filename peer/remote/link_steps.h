// The life of a peer's link to its host, as a table: every step, and what leads from one to another.
//
//     ┌─────────────────── kBusy ──────────┬───────────┐
//     ↓                                    │           │
//   kIdle ─kDialled→ kDialling ─kAnswered→ kJoining ─kReady→ kLive
//     └─────────────────┴── kLost ─────────┴→ kEnded ←kEnd── every step
//   kLive ─kLost→ kWaiting ─kDialled→ kRedialling ─kAnswered→ kRejoining ─kReady→ kLive
//                    ↑ ↺ kLost            │ kLost                │ kLost
//                    └────────────────────┴──────────────────────┘
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "peer/remote/remote_status.h"

namespace slosh {

enum class LinkStep : std::uint8_t {
  kIdle,        ///< nothing was tried yet
  kDialling,    ///< the first connection: no answer yet
  kJoining,     ///< the host answered; welcome, roster and scene are on their way
  kLive,        ///< bodies come, poses go
  kWaiting,     ///< contact was lost; the next try is due later
  kRedialling,  ///< a try to come back: no answer yet
  kRejoining,   ///< the host answered again
  kEnded,
};
constexpr std::size_t kLinkStepCount = 8;

enum class LinkEvent : std::uint8_t {
  kDialled,   ///< a connection was begun
  kAnswered,  ///< its handshake is over
  kReady,     ///< everything that a live link needs has come
  kBusy,      ///< the host has no room or no time now, and nothing was live yet: to be tried again
  kLost,      ///< the connection is gone, or could not be begun, or took too long
  kEnd,       ///< left, refused, given up, or the host is not understood
};
constexpr std::size_t kLinkEventCount = 6;

/// The next step; nothing when the event cannot come there.
constexpr std::optional<LinkStep> next_step(LinkStep step, LinkEvent event) {
  using S = LinkStep;
  using Row = std::array<std::optional<LinkStep>, kLinkEventCount>;
  constexpr auto kNo = std::nullopt;
  constexpr std::array<Row, kLinkStepCount> kTable{{
      // kDialled, kAnswered, kReady, kBusy, kLost, kEnd
      {S::kDialling, kNo, kNo, kNo, S::kEnded, S::kEnded},      // kIdle
      {kNo, S::kJoining, kNo, S::kIdle, S::kEnded, S::kEnded},  // kDialling
      {kNo, kNo, S::kLive, S::kIdle, S::kEnded, S::kEnded},     // kJoining
      {kNo, kNo, kNo, kNo, S::kWaiting, S::kEnded},             // kLive
      {S::kRedialling, kNo, kNo, kNo, S::kWaiting, S::kEnded},  // kWaiting
      {kNo, S::kRejoining, kNo, kNo, S::kWaiting, S::kEnded},   // kRedialling
      {kNo, kNo, S::kLive, kNo, S::kWaiting, S::kEnded},        // kRejoining
      {kNo, kNo, kNo, kNo, kNo, kNo},                           // kEnded
  }};
  return kTable[static_cast<std::size_t>(step)][static_cast<std::size_t>(event)];
}

/// As other threads are told.
constexpr LinkState state_of(LinkStep step) {
  switch (step) {
    case LinkStep::kIdle:
    case LinkStep::kDialling:
      return LinkState::kConnecting;
    case LinkStep::kJoining:
      return LinkState::kJoining;
    case LinkStep::kLive:
      return LinkState::kLive;
    case LinkStep::kWaiting:
    case LinkStep::kRedialling:
    case LinkStep::kRejoining:
      return LinkState::kReconnecting;
    case LinkStep::kEnded:
      break;
  }
  return LinkState::kEnded;
}

/// The handshake is over: the host is heard, and hears.
constexpr bool in_contact(LinkStep step) {
  return step == LinkStep::kJoining || step == LinkStep::kRejoining || step == LinkStep::kLive;
}
/// The link was never live.
constexpr bool before_live(LinkStep step) {
  return step == LinkStep::kIdle || step == LinkStep::kDialling || step == LinkStep::kJoining;
}

}  // namespace slosh
