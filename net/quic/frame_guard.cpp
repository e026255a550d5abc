#include "net/quic/frame_guard.h"

#include <algorithm>
#include <cstddef>

namespace slosh::quic {
namespace {

/// RFC 9000, 19 and RFC 9221, 4. ngtcp2 takes a type of one byte only, and so do we.
enum Frame : std::uint8_t {
  kPadding = 0x00,
  kPing = 0x01,
  kAck = 0x02,
  kAckEcn = 0x03,
  kResetStream = 0x04,
  kStopSending = 0x05,
  kCrypto = 0x06,
  kNewToken = 0x07,
  kStreamFirst = 0x08,
  kStreamLast = 0x0f,
  kMaxData = 0x10,
  kMaxStreamData = 0x11,
  kMaxStreamsBidi = 0x12,
  kMaxStreamsUni = 0x13,
  kDataBlocked = 0x14,
  kStreamDataBlocked = 0x15,
  kStreamsBlockedBidi = 0x16,
  kStreamsBlockedUni = 0x17,
  kNewConnectionId = 0x18,
  kRetireConnectionId = 0x19,
  kPathChallenge = 0x1a,
  kPathResponse = 0x1b,
  kClose = 0x1c,
  kCloseApplication = 0x1d,
  kHandshakeDone = 0x1e,
  kDatagram = 0x30,
  kDatagramWithLength = 0x31,
};

/// Reads on from a place in a payload; after the first thing that is not there nothing more is.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint64_t integer() {
    if (at_ >= bytes_.size()) return fail();
    const std::size_t size = std::size_t{1} << (bytes_[at_] >> 6);
    if (bytes_.size() - at_ < size) return fail();
    std::uint64_t value = bytes_[at_] & 0x3f;
    for (std::size_t i = 1; i < size; ++i) value = value << 8 | bytes_[at_ + i];
    at_ += size;
    return value;
  }
  void integers(std::uint64_t count) {
    // Each takes a byte at least, so a count that is too large ends soon.
    while (count-- > 0 && good_) integer();
  }
  void skip(std::uint64_t count) {
    if (count > bytes_.size() - at_)
      fail();
    else
      at_ += static_cast<std::size_t>(count);
  }
  std::uint8_t byte() {
    if (at_ >= bytes_.size()) return static_cast<std::uint8_t>(fail());
    return bytes_[at_++];
  }
  void to_end() { at_ = bytes_.size(); }
  bool good() const { return good_; }
  std::size_t at() const { return at_; }

 private:
  std::uint64_t fail() {
    good_ = false;
    at_ = bytes_.size();
    return 0;
  }
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

void read_acknowledgement(Reader& in, bool ecn, LossLedger* ledger) {
  auto newest = static_cast<std::int64_t>(in.integer());
  in.integer();  // delay
  const std::uint64_t ranges = in.integer();
  bool sound = true;
  // What is not sound is read on to its end all the same: the library looks at the first ranges only.
  for (std::uint64_t i = 0; i <= ranges && in.good(); ++i) {
    const auto gap = static_cast<std::int64_t>(i > 0 ? in.integer() + 2 : 0);
    const auto length = static_cast<std::int64_t>(in.integer());
    sound = sound && in.good() && gap <= newest && length <= newest - gap;
    if (!sound) continue;
    newest -= gap;
    if (ledger) ledger->acknowledged(newest - length, newest);
    newest -= length;
  }
  if (ecn) in.integers(3);
}

/// The body of a frame other than NEW_CONNECTION_ID; false when there is none such.
bool skip_frame(Reader& in, std::uint8_t type, LossLedger* ledger) {
  if (type >= kStreamFirst && type <= kStreamLast) {
    in.integer();
    if (type & 0x04) in.integer();
    if (type & 0x02)
      in.skip(in.integer());
    else
      in.to_end();
    return in.good();
  }
  switch (type) {
    case kPadding:
    case kPing:
    case kHandshakeDone:
      break;
    case kAck:
    case kAckEcn:
      read_acknowledgement(in, type == kAckEcn, ledger);
      break;
    case kResetStream:
      in.integers(3);
      break;
    case kStopSending:
    case kMaxStreamData:
    case kStreamDataBlocked:
      in.integers(2);
      break;
    case kCrypto:
      in.integer();
      in.skip(in.integer());
      break;
    case kNewToken:
    case kDatagramWithLength:
      in.skip(in.integer());
      break;
    case kMaxData:
    case kMaxStreamsBidi:
    case kMaxStreamsUni:
    case kDataBlocked:
    case kStreamsBlockedBidi:
    case kStreamsBlockedUni:
    case kRetireConnectionId:
      in.integer();
      break;
    case kPathChallenge:
    case kPathResponse:
      in.skip(8);
      break;
    case kClose:
      in.integers(2);
      in.skip(in.integer());
      break;
    case kCloseApplication:
      in.integer();
      in.skip(in.integer());
      break;
    case kDatagram:
      in.to_end();
      break;
    default:
      return false;
  }
  return in.good();
}

}  // namespace

FrameVerdict guard_frames(std::span<std::uint8_t> payload, LossLedger* ledger) {
  Reader in(payload);
  while (in.at() < payload.size()) {
    const std::size_t start = in.at();
    const std::uint8_t type = in.byte();
    if (type != kNewConnectionId) {
      if (!skip_frame(in, type, ledger)) return FrameVerdict::kMalformed;
      continue;
    }
    const std::uint64_t sequence = in.integer();
    const std::uint64_t retire_prior_to = in.integer();
    const std::uint8_t size = in.byte();
    in.skip(size);
    in.skip(16);  // the reset token
    if (!in.good() || size < 1 || size > 20 || retire_prior_to > sequence) return FrameVerdict::kMalformed;
    if (retire_prior_to > 0) return FrameVerdict::kRetiresAnId;
    const auto frame = payload.subspan(start, in.at() - start);
    std::fill(frame.begin(), frame.end(), std::uint8_t{kPadding});
    frame[0] = kPing;
  }
  return FrameVerdict::kPass;
}

}  // namespace slosh::quic
