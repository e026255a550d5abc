// The memory that ngtcp2 takes for one connection, given back with the connection whatever the library
// forgot.
//
// ngtcp2 0.12 (Debian 12) loses some hundred bytes with about every packet that it took for lost and that
// then came after all: 19 kB in 3 s of a link that turns packets round (found by AddressSanitizer, Losses.*).
#pragma once

#include <ngtcp2/ngtcp2.h>

#include <cstddef>

namespace slosh::quic {

class ConnectionMemory {
 public:
  ConnectionMemory();
  ~ConnectionMemory();
  ConnectionMemory(const ConnectionMemory&) = delete;
  ConnectionMemory& operator=(const ConnectionMemory&) = delete;

  /// For ngtcp2_conn_client_new and _server_new; lives as long as this.
  const ngtcp2_mem* functions() const { return &functions_; }
  /// Blocks that are taken and not given back.
  std::size_t blocks() const { return blocks_; }

 private:
  // Before each block: the list of them.
  struct alignas(std::max_align_t) Header {
    Header* before;
    Header* after;
  };

  void* take(std::size_t size, bool cleared);
  void* resize(void* memory, std::size_t size);
  void give_back(void* memory);
  void link(Header* header);
  void unlink(Header* header);

  ngtcp2_mem functions_;
  Header all_;
  std::size_t blocks_ = 0;
};

}  // namespace slosh::quic
