// A UDP socket that reads and writes many packets a system call.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "net/quic/address.h"

namespace slosh::quic {

constexpr std::size_t kMaxPacket = 1200;  ///< bytes of UDP payload that we send: below any path's MTU

/// A packet as it came.
struct Arrival {
  Address from;
  Address to;  ///< our address that it was sent to
  std::span<const std::uint8_t> bytes;
};

class UdpSocket {
 public:
  /// A socket that listens at `local`, whose port 0 takes any; "[::]" takes IPv4 too. Errors: in use, not
  /// allowed, no such address.
  static Result<std::unique_ptr<UdpSocket>> listen(const Address& local);
  /// A socket of its own that only `remote` can reach. Errors: no route.
  static Result<std::unique_ptr<UdpSocket>> connect(const Address& remote);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  int descriptor() const { return descriptor_; }
  const Address& local() const { return local_; }

  /// The next packets, at most a batch; empty when there are none. Valid until the next call.
  std::span<const Arrival> receive();

  /// Room for one packet of kMaxPacket bytes; flushes first when the batch is full. Empty while blocked().
  std::span<std::uint8_t> space();
  /// Sends, now or with others later, what was written to space().
  void add(const Address& from, const Address& to, std::size_t size);
  /// Sends what was added. What the kernel has no room for stays and blocks the socket.
  void flush();
  bool blocked() const { return blocked_; }  ///< call flush() when the descriptor is writable

  /// The last error of sending, as errno: 0 again after something was sent. ECONNREFUSED (nobody listens
  /// there) stays until something is received.
  int send_error() const { return send_error_; }

 private:
  struct Run;      // consecutive packets of one size to one address
  struct Buffers;  // of system calls
  explicit UdpSocket(int descriptor);
  void set_options(int family);
  bool send_runs();
  void split_runs();

  int descriptor_;
  Address local_;
  bool connected_ = false;
  bool wildcard_ = false;
  bool segmentation_ = true;  // UDP_SEGMENT works here
  bool blocked_ = false;
  int send_error_ = 0;
  std::vector<Run> runs_;
  std::size_t first_run_ = 0;  // not sent yet
  std::size_t used_ = 0;       // bytes of the arena
  std::unique_ptr<std::uint8_t[]> arena_;
  std::unique_ptr<Buffers> buffers_;
};

}  // namespace slosh::quic
