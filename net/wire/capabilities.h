// What a side understands beyond the messages that every peer of this version has.
//
// Hello has the peer's bits, Welcome those that both sides have: these are agreed. A bit that is not known is
// left out of account. A field behind a capability is written only when that is agreed
// (`if (v.agreed(kX)) v.natural(…)`), and a message type behind one is sent only then: so neither makes
// another version. Fields of a capability that Hello itself needs go into Hello's `later`, which who does not
// know them skips.
#pragma once

#include <cstdint>

namespace slosh::wire {

using Capabilities = std::uint64_t;  ///< bits

constexpr Capabilities kRosterChanges = 1u
                                        << 0;  ///< RosterChange follows the first Roster in place of others

constexpr Capabilities kFluidWrenches = 1u << 1;  ///< FluidWrench comes for each body that the peer holds

/// PoseSample has the energy that its person put in, and GripEntry that and the number of the sample that the
/// step used.
constexpr Capabilities kCouplings = 1u << 2;

/// Parameter::kGripStiffness may be asked for, and WorldInfo has the grips' stiffnesses.
constexpr Capabilities kGripStiffnesses = 1u << 3;

/// A sample may say that its person does not feel what they hold yet (HoldsOn::kUnfelt); until they do, the
/// host goes on holding.
constexpr Capabilities kFeltHands = 1u << 4;

/// PoseSample has no `tick_ack`: nothing ever read it.
constexpr Capabilities kNoTickAcks = 1u << 5;

/// Rights follows WorldInfo: what the peer's link lets it ask of the world. Where this is not agreed nothing
/// is said of it, and what is refused is refused in an Answer.
constexpr Capabilities kLinkRights = 1u << 6;

/// GripEntry has whether a stand holds the grip, and the stiffness that acts.
constexpr Capabilities kHolds = 1u << 7;

/// Task follows WorldInfo where the scene has a guided task.
constexpr Capabilities kTasks = 1u << 8;

/// Task says which hands are to change their grips.
constexpr Capabilities kTaskHands = 1u << 9;

/// Cuts follows WorldInfo where bodies are cut, and each cut.
constexpr Capabilities kBodyCuts = 1u << 10;

/// Task says how many steps are done.
constexpr Capabilities kTaskSteps = 1u << 11;

/// What this program understands; a peer's Hello asks for all of it.
constexpr Capabilities kOurCapabilities = kRosterChanges | kFluidWrenches | kCouplings | kGripStiffnesses |
                                          kFeltHands | kNoTickAcks | kLinkRights | kHolds | kTasks |
                                          kTaskHands | kBodyCuts | kTaskSteps;
/// For what has no other side: pages, tests of single messages, files.
constexpr Capabilities kAllCapabilities = ~Capabilities{0};

}  // namespace slosh::wire
