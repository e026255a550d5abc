// The protocol's number, and how large anything in a message may be.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace slosh::wire {

constexpr std::uint32_t kProtocolVersion = 2;
inline constexpr char kAlpn[] =
    "slosh/2";  ///< the TLS application protocol; a peer of another version fails here

constexpr std::size_t kMaxDatagram = 1150;           ///< bytes of payload, before path MTU discovery
constexpr std::size_t kMaxControlMessage = 1 << 17;  ///< bytes of payload; a full RosterChange is the largest
constexpr std::size_t kMaxSceneBytes = 64u << 20;    ///< compressed and decompressed alike
constexpr std::size_t kMaxName = 32;                 ///< bytes of a person's name
constexpr std::size_t kMaxText = 400;                ///< bytes of a sentence
constexpr std::uint32_t kMaxGrips = 64;
constexpr std::size_t kMaxFluidVolumes = 1024;
constexpr std::uint32_t kMaxHandMoves = 256;  ///< of one task
constexpr std::uint32_t kMaxBodies = 256;
constexpr std::uint32_t kMaxPeers = 1024;
constexpr std::uint32_t kMaxFluids = 32;
constexpr std::uint64_t kMaxTick = std::uint64_t{1} << 48;
constexpr double kMaxTime = 1e7;                ///< s
constexpr double kMaxPosition = 1e4;            ///< m
constexpr double kMaxSpeed = 1e4;               ///< m/s, rad/s
constexpr double kMaxForce = 1e7;               ///< N, N·m
constexpr std::size_t kMaxPoseRepeats = 13;     ///< as many as fit into a datagram
constexpr std::size_t kMaxMissingRanges = 128;  ///< likewise
constexpr double kMaxEnergy = 1e9;              ///< J
constexpr double kMaxViscosity = 1e7;           ///< Pa·s, as scenes have it
constexpr double kMaxGravityScale = 2.0;        ///< times the scene's
constexpr double kMinGripStiffness = 0.05;      ///< times the scene's
constexpr double kMaxGripStiffness = 4.0;
constexpr std::size_t kTokenBytes = 16;

using Token = std::array<std::uint8_t, kTokenBytes>;

}  // namespace slosh::wire
