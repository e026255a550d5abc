// Who this person is to hosts: a key in a file, the same every time.
#pragma once

#include <filesystem>
#include <string>

#include "net/quic/endpoint.h"

namespace slosh {

struct PeerKey {
  Identity identity;
  bool kept = false;  ///< in a file: a peer that is started again is the same person
  std::string note;   ///< for people: why it is not kept; empty when all is as usual
};

/// The key in `file`, made there on first use (mode 0600, its folder too). An empty `file` means
/// $XDG_DATA_HOME/slosh/peer_key; when another running peer uses that, or it cannot be written, a key for
/// this run alone. A key in use stays locked until this process ends. Errors, for a `file` that was named: in
/// use, not a key, cannot be read or made.
Result<PeerKey> open_peer_key(const std::filesystem::path& file);

}  // namespace slosh
