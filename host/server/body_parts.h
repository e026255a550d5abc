// From the state of the bodies to datagrams: cut into parts, coded once, stamped for each peer.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "net/channel.h"
#include "net/quic/endpoint.h"
#include "net/wire/messages.h"
#include "scenes/scene.h"

namespace slosh {

/// Codes one state for any number of peers. A fixed body that nobody measures is left out. One thread.
class BodyParts {
 public:
  /// For peers that have agreed to the same of what these messages have behind capabilities.
  explicit BodyParts(const Scene& scene, wire::Capabilities agreed = wire::kOurCapabilities);

  /// Takes in a state; what to() gave before is not changed by it. `numbers`: one a grip, its holder's number
  /// of the sample that the step used; or none at all.
  void set(const BodyMessage& message, const std::vector<std::uint64_t>& numbers = {});

  /// The datagrams for a peer whose newest used sample is this; 0, 0 for one without (all of those share the
  /// same bytes). Each is at most wire::kMaxDatagram long.
  const std::vector<SharedBytes>& to(std::uint64_t pose_number, std::int64_t pose_stamp_ns);

 private:
  void code(std::uint64_t pose_number, std::int64_t pose_stamp_ns, std::vector<SharedBytes>& out);

  wire::Capabilities agreed_;
  std::vector<bool> sent_;           // one a body
  wire::Bodies header_;              // without entries
  std::vector<wire::Bytes> tails_;   // the entries of each part, coded
  std::vector<SharedBytes> shared_;  // for peers without samples; empty = not coded yet
  std::vector<SharedBytes> own_;
};

}  // namespace slosh
