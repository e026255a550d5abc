// The host moves a peer from one stream of snapshots to another (finer, coarser, only the shell): a decoder
// each, and what they give in one row.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "net/codec/snapshot_codec.h"

namespace slosh {

/// The stream on show goes on until a later one has given a frame; then it is forgotten. One thread.
class StreamDecoders {
 public:
  /// As SnapshotDecoder::take.
  wire::Fault take(std::span<const std::uint8_t> datagram);
  /// As SnapshotDecoder::next. Epochs are told apart across streams by their highest byte.
  std::optional<DecodedFrame> next(std::uint32_t patience);
  /// Of the stream that came last.
  wire::SnapshotFeedback feedback();

 private:
  struct Stream {
    std::uint32_t number = 0;
    SnapshotDecoder decoder;
  };
  std::optional<Stream> shown_;
  std::optional<Stream> coming_;
  std::uint32_t last_ = 0;  // stream of the newest piece
  std::uint32_t changes_ = 0;
};

}  // namespace slosh
