// One guest of an EvilHost, between its parts: evil_host.cpp greets, evil_tricks.cpp does the harm.
#pragma once

#include "tests/hostile/evil_host.h"

namespace slosh::hostile {

constexpr double kEvilStep = 0.002;  // s, a tick of the world that is pretended

struct EvilHost::Guest {
  ConnectionId id = 0;
  std::int64_t control = -1;
  wire::StreamSplitter splitter;
  std::unique_ptr<Mischief> mischief;  // from Hello on
  Trick trick = Trick::kSilence;
  bool entered = false;
  bool left = false;
  std::uint64_t tick = 100;
  std::uint32_t run = 0;
  std::uint64_t turns = 0;
  std::uint64_t patience = 0;  // turns until it is sent away
  std::uint64_t pose_number = 0;
  std::unique_ptr<SnapshotEncoder> encoder;
  Snapshot snapshot;
};

}  // namespace slosh::hostile
