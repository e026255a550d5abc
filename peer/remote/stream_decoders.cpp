#include "peer/remote/stream_decoders.h"

#include "net/wire/fields.h"

namespace slosh {

wire::Fault StreamDecoders::take(std::span<const std::uint8_t> datagram) {
  // The stream's number is a piece's first field.
  if (datagram.empty()) return {"type", "ends too early"};
  wire::Reader reader(datagram.subspan(1));
  std::uint32_t number = 0;
  reader.natural("stream", number, 0, 255);
  if (!reader.ok()) return reader.fault();
  if (shown_ && shown_->number == number) {
    last_ = number;
    return shown_->decoder.take(datagram);
  }
  if (!coming_ || coming_->number != number) {
    // Only what begins a stream is worth a decoder: a damaged piece must not cost us the one that is coming.
    Stream fresh{number, {}};
    if (wire::Fault fault = fresh.decoder.take(datagram)) return fault;
    coming_ = std::move(fresh);
    last_ = number;
    return {};
  }
  last_ = number;
  return coming_->decoder.take(datagram);
}

std::optional<DecodedFrame> StreamDecoders::next(std::uint32_t patience) {
  std::optional<DecodedFrame> frame;
  if (coming_) {
    frame = coming_->decoder.next(patience);
    if (frame) {
      shown_ = std::move(coming_);
      coming_.reset();
      changes_ += 1;
    }
  }
  if (!frame && shown_) frame = shown_->decoder.next(patience);
  if (frame) frame->epoch = (frame->epoch & 0xffffff) | (changes_ << 24);
  return frame;
}

wire::SnapshotFeedback StreamDecoders::feedback() {
  if (coming_ && coming_->number == last_) return coming_->decoder.feedback();
  return shown_ ? shown_->decoder.feedback() : wire::SnapshotFeedback{};
}

}  // namespace slosh
