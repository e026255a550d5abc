// What a link lets those do who come by it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "net/wire/messages.h"

namespace slosh {

/// The numbers are kept in files: the first two are wire::Role's, as all links had before `run` was there. So
/// an old link to hold has the lesser right.
enum class LinkRole : std::uint8_t {
  kHold,   ///< takes grips, lets go, sets the stiffness of those that it holds
  kWatch,  ///< looks on
  kRun,    ///< holds, and runs the world for everybody: pause, continue, reset, gravity, viscosity
};
constexpr std::array kLinkRoleNames{"hold", "watch", "run"};

constexpr bool may_hold(LinkRole role) {
  return role != LinkRole::kWatch;
}

/// As peers are told, of whom earlier ones know two.
constexpr wire::Role wire_role(LinkRole role) {
  return may_hold(role) ? wire::Role::kParticipant : wire::Role::kSpectator;
}

constexpr std::optional<LinkRole> link_role_named(std::string_view name) {
  for (std::size_t i = 0; i < kLinkRoleNames.size(); ++i) {
    if (name == kLinkRoleNames[i]) return static_cast<LinkRole>(i);
  }
  return std::nullopt;
}

}  // namespace slosh
