// Looks at what the other side says before ngtcp2 does, and takes out what the library would not survive.
#pragma once

#include <cstdint>
#include <span>

#include "net/quic/loss_ledger.h"

namespace slosh::quic {

/// Takes NEW_CONNECTION_ID out of a decrypted packet.
///
/// ngtcp2 (0.12 to 1.11) ends the whole process by an assertion when it is told to retire a connection id
/// twice: by a frame that is repeated after its number was retired (which RFC 9000 allows), or by a move that
/// begins while another is being looked into. And it closes honest connections when two moves meet, because
/// it counts an id twice. It does none of that with one id of the other side's: so it gets no second one. A
/// frame in its place (PING) keeps the packet acknowledged. Moves work without: the library goes on with the
/// id that it has.
///
/// Who asks to retire an id (Retire Prior To above 0) asks for what is not done here, and is refused.
enum class FrameVerdict : std::uint8_t {
  kPass,         ///< the payload may have been changed
  kMalformed,    ///< ends the connection: no frame of QUIC, or cut short
  kRetiresAnId,  ///< ends the connection
};

/// `payload` is the plaintext of a 1-RTT packet. Nothing that does not decode here reaches the library, which
/// takes more for frames than there are: it would see a frame behind one that is none.
/// What is acknowledged is written into `ledger`, if there is one.
FrameVerdict guard_frames(std::span<std::uint8_t> payload, LossLedger* ledger = nullptr);

}  // namespace slosh::quic
