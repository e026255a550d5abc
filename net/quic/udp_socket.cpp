#include "net/quic/udp_socket.h"

#include <fcntl.h>
#include <netinet/udp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "net/quic/udp_socket_impl.h"

namespace slosh::quic {
namespace {

Error socket_error(const Address& address) {
  const int code = errno;
  std::string mend = "Choose another address";
  if (code == EAFNOSUPPORT) mend = "This machine has no IPv6: take 0.0.0.0 in place of [::]";
  if (code == EADDRINUSE) mend = "Choose another port, or end the program that uses it";
  if (code == EACCES) mend = "Choose a port from 1024 upwards";
  if (code == EADDRNOTAVAIL) mend = "Choose an address of this machine, or 0.0.0.0 or [::] for all of them";
  return {"address " + address.text(), std::strerror(code), mend};
}

void grow_buffer(int descriptor, int force, int plain) {
  constexpr int kBytes = 4 << 20;
  // The first needs a privilege, the second is cut to the system's limit: both may fail without harm.
  if (setsockopt(descriptor, SOL_SOCKET, force, &kBytes, sizeof(kBytes)) != 0)
    setsockopt(descriptor, SOL_SOCKET, plain, &kBytes, sizeof(kBytes));
}

void switch_on(int descriptor, int level, int option, int value = 1) {
  setsockopt(descriptor, level, option, &value, sizeof(value));
}

Address bound_address(int descriptor) {
  sockaddr_storage storage{};
  socklen_t size = sizeof(storage);
  getsockname(descriptor, reinterpret_cast<sockaddr*>(&storage), &size);
  return {reinterpret_cast<const sockaddr*>(&storage), size};
}

/// Our address out of a packet's control data.
void read_local(const msghdr& header, Address& to) {
  for (cmsghdr* part = CMSG_FIRSTHDR(&header); part; part = CMSG_NXTHDR(const_cast<msghdr*>(&header), part)) {
    if (part->cmsg_level == IPPROTO_IP && part->cmsg_type == IP_PKTINFO) {
      in_pktinfo info;
      std::memcpy(&info, CMSG_DATA(part), sizeof(info));
      if (to.any.sa_family == AF_INET) to.v4.sin_addr = info.ipi_addr;
    } else if (part->cmsg_level == IPPROTO_IPV6 && part->cmsg_type == IPV6_PKTINFO) {
      in6_pktinfo info;
      std::memcpy(&info, CMSG_DATA(part), sizeof(info));
      if (to.any.sa_family == AF_INET6) {
        to.v6.sin6_addr = info.ipi6_addr;
        to.v6.sin6_scope_id = IN6_IS_ADDR_LINKLOCAL(&info.ipi6_addr) ? info.ipi6_ifindex : 0;
      }
    }
  }
}

}  // namespace

UdpSocket::UdpSocket(int descriptor)
    : descriptor_(descriptor),
      arena_(std::make_unique_for_overwrite<std::uint8_t[]>(kArena)),
      buffers_(std::make_unique<Buffers>()) {}

UdpSocket::~UdpSocket() {
  close(descriptor_);
}

void UdpSocket::set_options(int family) {
  grow_buffer(descriptor_, SO_SNDBUFFORCE, SO_SNDBUF);
  grow_buffer(descriptor_, SO_RCVBUFFORCE, SO_RCVBUF);
  switch_on(descriptor_, IPPROTO_IP, IP_PKTINFO);
  // Never fragment: a path that cannot carry 1200 bytes cannot carry QUIC.
  switch_on(descriptor_, IPPROTO_IP, IP_MTU_DISCOVER, IP_PMTUDISC_PROBE);
  if (family == AF_INET6) {
    switch_on(descriptor_, IPPROTO_IPV6, IPV6_RECVPKTINFO);
    switch_on(descriptor_, IPPROTO_IPV6, IPV6_MTU_DISCOVER, IPV6_PMTUDISC_PROBE);
  }
}

Result<std::unique_ptr<UdpSocket>> UdpSocket::listen(const Address& local) {
  const int family = local.any.sa_family;
  const int descriptor = ::socket(family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor < 0) return socket_error(local);
  std::unique_ptr<UdpSocket> made(new UdpSocket(descriptor));
  made->set_options(family);
  if (family == AF_INET6) switch_on(descriptor, IPPROTO_IPV6, IPV6_V6ONLY, local.is_wildcard() ? 0 : 1);
  if (bind(descriptor, &local.any, local.length) != 0) return socket_error(local);
  made->local_ = bound_address(descriptor);
  made->wildcard_ = local.is_wildcard();
  return made;
}

Result<std::unique_ptr<UdpSocket>> UdpSocket::connect(const Address& remote) {
  const int family = remote.any.sa_family;
  const int descriptor = ::socket(family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor < 0) return socket_error(remote);
  std::unique_ptr<UdpSocket> made(new UdpSocket(descriptor));
  made->set_options(family);
  if (::connect(descriptor, &remote.any, remote.length) != 0) return socket_error(remote);
  made->local_ = bound_address(descriptor);
  made->connected_ = true;
  return made;
}

std::span<const Arrival> UdpSocket::receive() {
  Buffers& b = *buffers_;
  for (std::size_t i = 0; i < kBatch; ++i) {
    b.in_vectors[i] = {b.in_bytes.get() + i * kInSize, kInSize};
    msghdr& header = b.in_headers[i].msg_hdr;
    header = {};
    header.msg_name = &b.in_names[i];
    header.msg_namelen = sizeof(b.in_names[i]);
    header.msg_iov = &b.in_vectors[i];
    header.msg_iovlen = 1;
    header.msg_control = b.in_control[i];
    header.msg_controllen = sizeof(b.in_control[i]);
  }
  int count = 0;
  do {
    count = recvmmsg(descriptor_, b.in_headers, kBatch, MSG_DONTWAIT, nullptr);
    // A connected socket reports here that an earlier packet was refused; the next call has the packets.
    if (count < 0 && errno == ECONNREFUSED) send_error_ = ECONNREFUSED;
  } while (count < 0 && (errno == EINTR || errno == ECONNREFUSED));
  b.arrivals.clear();
  if (count > 0 && send_error_ == ECONNREFUSED) send_error_ = 0;
  for (int i = 0; i < count; ++i) {
    const msghdr& header = b.in_headers[i].msg_hdr;
    // Longer than anybody may send us, or nothing at all (on which ngtcp2 asserts).
    if ((header.msg_flags & MSG_TRUNC) || b.in_headers[i].msg_len == 0) continue;
    Arrival arrival;
    arrival.from = Address(reinterpret_cast<const sockaddr*>(&b.in_names[i]), header.msg_namelen);
    arrival.to = local_;
    if (wildcard_) read_local(header, arrival.to);
    arrival.bytes = {b.in_bytes.get() + i * kInSize, b.in_headers[i].msg_len};
    b.arrivals.push_back(arrival);
  }
  return b.arrivals;
}

std::span<std::uint8_t> UdpSocket::space() {
  if (blocked_) return {};
  if (used_ + kMaxPacket > kArena || runs_.size() - first_run_ >= kBatch) flush();
  if (blocked_) return {};
  return {arena_.get() + used_, kMaxPacket};
}

void UdpSocket::add(const Address& from, const Address& to, std::size_t size) {
  if (!runs_.empty() && segmentation_) {
    Run& last = runs_.back();
    // A shorter packet may end a run, and nothing follows it.
    if (last.open && size <= last.segment && last.count < kMaxSegments && last.to == to &&
        last.from == from) {
      last.size += size;
      ++last.count;
      last.open = size == last.segment;
      used_ += size;
      return;
    }
  }
  runs_.push_back({from, to, used_, size, static_cast<std::uint16_t>(size), 1, true});
  used_ += size;
}

}  // namespace slosh::quic
