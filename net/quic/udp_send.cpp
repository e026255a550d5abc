// The sending half of UdpSocket: runs of packets into few system calls.
#include <netinet/udp.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "net/quic/udp_socket_impl.h"

#ifndef UDP_SEGMENT
#define UDP_SEGMENT 103
#endif

namespace slosh::quic {
namespace {

template <class T>
void append_control(msghdr& header, std::size_t& used, int level, int type, const T& value) {
  auto* part = reinterpret_cast<cmsghdr*>(static_cast<std::uint8_t*>(header.msg_control) + used);
  part->cmsg_level = level;
  part->cmsg_type = type;
  part->cmsg_len = CMSG_LEN(sizeof(T));
  std::memcpy(CMSG_DATA(part), &value, sizeof(T));
  used += CMSG_SPACE(sizeof(T));
}

}  // namespace

void UdpSocket::flush() {
  const bool done = send_runs();
  blocked_ = !done;
  if (!done) return;
  runs_.clear();
  first_run_ = 0;
  used_ = 0;
}

/// False when the kernel has no room.
bool UdpSocket::send_runs() {
  Buffers& b = *buffers_;
  std::size_t refused_at = runs_.size();
  while (first_run_ < runs_.size()) {
    const std::size_t count = std::min(kBatch, runs_.size() - first_run_);
    for (std::size_t i = 0; i < count; ++i) {
      Run& run = runs_[first_run_ + i];
      b.out_vectors[i] = {arena_.get() + run.start, run.size};
      msghdr& header = b.out_headers[i].msg_hdr;
      header = {};
      if (!connected_) {
        header.msg_name = &run.to.any;
        header.msg_namelen = run.to.length;
      }
      header.msg_iov = &b.out_vectors[i];
      header.msg_iovlen = 1;
      header.msg_control = b.out_control[i];
      std::size_t used = 0;
      if (run.count > 1) append_control(header, used, SOL_UDP, UDP_SEGMENT, run.segment);
      // A host of many addresses answers from the one that it was asked at.
      if (wildcard_ && run.from.any.sa_family == AF_INET && !run.from.is_wildcard()) {
        in_pktinfo info{};
        info.ipi_spec_dst = run.from.v4.sin_addr;
        append_control(header, used, IPPROTO_IP, IP_PKTINFO, info);
      } else if (wildcard_ && run.from.any.sa_family == AF_INET6 && !run.from.is_wildcard()) {
        in6_pktinfo info{};
        info.ipi6_addr = run.from.v6.sin6_addr;
        info.ipi6_ifindex = run.from.v6.sin6_scope_id;
        append_control(header, used, IPPROTO_IPV6, IPV6_PKTINFO, info);
      }
      header.msg_controllen = used;
      if (used == 0) header.msg_control = nullptr;
    }
    const int sent = sendmmsg(descriptor_, b.out_headers, static_cast<unsigned>(count), MSG_DONTWAIT);
    if (sent > 0) {
      if (send_error_ != ECONNREFUSED) send_error_ = 0;
      first_run_ += static_cast<std::size_t>(sent);
      continue;
    }
    const int code = errno;
    if (code == EINTR) continue;
    if (code == EAGAIN || code == EWOULDBLOCK) return false;
    if (code == ECONNREFUSED && refused_at != first_run_) {
      // That was about an earlier packet; this one has not been tried yet.
      send_error_ = code;
      refused_at = first_run_;
      continue;
    }
    if ((code == EIO || code == EINVAL || code == EOPNOTSUPP) && runs_[first_run_].count > 1) {
      segmentation_ = false;  // this network card cannot: packet by packet from here on
      split_runs();
      continue;
    }
    // Counts as lost, as if the network had dropped it: QUIC mends or times out.
    send_error_ = code;
    ++first_run_;
  }
  return true;
}

void UdpSocket::split_runs() {
  std::vector<Run> single;
  for (std::size_t i = first_run_; i < runs_.size(); ++i) {
    const Run& run = runs_[i];
    for (std::size_t start = 0; start < run.size; start += run.segment) {
      Run part = run;
      part.start = run.start + start;
      part.size = std::min<std::size_t>(run.segment, run.size - start);
      part.count = 1;
      part.open = false;
      single.push_back(part);
    }
  }
  runs_ = std::move(single);
  first_run_ = 0;
}

}  // namespace slosh::quic
