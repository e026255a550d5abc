// What the two halves of UdpSocket share.
#pragma once

#include <sys/socket.h>
#include <sys/uio.h>

#include "net/quic/udp_socket.h"

namespace slosh::quic {

constexpr std::size_t kBatch = 64;                // messages a system call
constexpr std::size_t kInSize = 2048;             // bytes; more than any path carries unfragmented
constexpr std::size_t kArena = 256 * kMaxPacket;  // bytes of packets that wait for one flush
constexpr std::size_t kMaxSegments = 50;          // of one run: below the kernel's 64 kB
constexpr std::size_t kControl = 128;             // bytes of control data a message

struct UdpSocket::Run {
  Address from;
  Address to;
  std::size_t start = 0;  // in the arena
  std::size_t size = 0;   // bytes
  std::uint16_t segment = 0;
  std::size_t count = 0;
  bool open = true;  // another packet of `segment` bytes or fewer may follow
};

struct UdpSocket::Buffers {
  std::unique_ptr<std::uint8_t[]> in_bytes = std::make_unique_for_overwrite<std::uint8_t[]>(kBatch * kInSize);
  sockaddr_storage in_names[kBatch];
  iovec in_vectors[kBatch];
  mmsghdr in_headers[kBatch];
  alignas(cmsghdr) std::uint8_t in_control[kBatch][kControl];
  std::vector<Arrival> arrivals;
  iovec out_vectors[kBatch];
  mmsghdr out_headers[kBatch];
  alignas(cmsghdr) std::uint8_t out_control[kBatch][kControl];
};

}  // namespace slosh::quic
