#include "net/impair/relay.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <queue>
#include <thread>

#include "net/clock.h"
#include "net/impair/fate.h"
#include "net/quic/address.h"

namespace slosh {
namespace {

using quic::Address;

constexpr std::size_t kMappings = 512;
constexpr std::size_t kWaiting = 200'000;  // packets under way at most

int open_socket(int family) {
  const int descriptor = socket(family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  constexpr int kBytes = 4 << 20;
  if (descriptor >= 0)
    for (const int option : {SO_SNDBUFFORCE, SO_RCVBUFFORCE, SO_SNDBUF, SO_RCVBUF})
      setsockopt(descriptor, SOL_SOCKET, option, &kBytes, sizeof(kBytes));
  return descriptor;
}

/// A peer, and the socket by which we speak to the host for it.
struct Mapping {
  Address peer;
  int descriptor = -1;
};

struct Waiting {
  std::int64_t due_ns;
  std::uint64_t order;
  Relay::Way way;
  std::size_t mapping;
  Relay::Packet packet;
  bool operator>(const Waiting& other) const {
    return due_ns != other.due_ns ? due_ns > other.due_ns : order > other.order;
  }
};

class UdpRelay final : public Relay {
 public:
  UdpRelay(const RelayOptions& options, const Address& host, int listener, const Address& local)
      : host_(host),
        listener_(listener),
        local_(local),
        wake_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
        fates_{Fate(options.up, options.seed * 2), Fate(options.down, options.seed * 2 + 1)},
        thread_([this] { run(); }) {}

  ~UdpRelay() override {
    stop_ = true;
    poke();
    thread_.join();
    for (const Mapping& mapping : mappings_) close(mapping.descriptor);
    close(listener_);
    close(wake_);
  }

  std::string address() const override { return local_.text(); }

  void set(const Impairment& up, const Impairment& down) override {
    const std::lock_guard lock(mutex_);
    fates_[0].set(up);
    fates_[1].set(down);
  }
  void dark(bool cable_pulled) override { dark_ = cable_pulled; }
  void rebind() override {
    rebind_ = true;
    poke();
  }
  void capture(std::size_t count) override {
    const std::lock_guard lock(mutex_);
    capture_ = count;
    for (auto& packets : captured_) packets.clear();
  }
  std::vector<Packet> captured(Way way) const override {
    const std::lock_guard lock(mutex_);
    return captured_[static_cast<int>(way)];
  }
  void inject(Way way, const Packet& packet) override {
    {
      const std::lock_guard lock(mutex_);
      injected_.emplace_back(way, packet);
    }
    poke();
  }
  void tamper(std::function<void(Way, Packet&)> change) override {
    const std::lock_guard lock(mutex_);
    tamper_ = std::move(change);
  }
  RelayStats stats() const override {
    const std::lock_guard lock(mutex_);
    return stats_;
  }

 private:
  void poke() {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(wake_, &one, sizeof(one));
  }

  void run() {
    std::vector<pollfd> descriptors;
    while (!stop_) {
      descriptors.clear();
      descriptors.push_back({wake_, POLLIN, 0});
      descriptors.push_back({listener_, POLLIN, 0});
      for (const Mapping& mapping : mappings_) descriptors.push_back({mapping.descriptor, POLLIN, 0});
      timespec timeout{1, 0};
      if (!waiting_.empty()) {
        const std::int64_t left = std::max<std::int64_t>(waiting_.top().due_ns - steady_now_ns(), 0);
        if (left < kNanosecondsPerSecond) timeout = {0, static_cast<long>(left)};
      }
      ppoll(descriptors.data(), descriptors.size(), &timeout, nullptr);
      std::uint64_t count = 0;
      while (read(wake_, &count, sizeof(count)) > 0) {
      }
      if (rebind_.exchange(false)) renew_sockets();
      const std::size_t mappings = mappings_.size();
      for (std::size_t i = 0; i < mappings; ++i) from_host(i);
      from_peers();
      send_injected();
      send_due();
    }
  }

  void from_peers() {
    sockaddr_storage name{};
    for (int i = 0; i < 256; ++i) {
      socklen_t size = sizeof(name);
      const ssize_t bytes =
          recvfrom(listener_, buffer_.data(), buffer_.size(), 0, reinterpret_cast<sockaddr*>(&name), &size);
      if (bytes < 0) return;
      const std::size_t mapping = mapping_of(Address(reinterpret_cast<sockaddr*>(&name), size));
      if (mapping < mappings_.size()) take(Way::kUp, mapping, static_cast<std::size_t>(bytes));
    }
  }

  void from_host(std::size_t mapping) {
    for (int i = 0; i < 256; ++i) {
      const ssize_t bytes = recv(mappings_[mapping].descriptor, buffer_.data(), buffer_.size(), 0);
      if (bytes < 0 && errno == ECONNREFUSED) continue;
      if (bytes < 0) return;
      take(Way::kDown, mapping, static_cast<std::size_t>(bytes));
    }
  }

  std::size_t mapping_of(const Address& peer) {
    for (std::size_t i = 0; i < mappings_.size(); ++i)
      if (mappings_[i].peer == peer) return last_mapping_ = i;
    if (mappings_.size() >= kMappings) return kMappings;
    const int descriptor = to_host();
    if (descriptor < 0) return kMappings;
    mappings_.push_back({peer, descriptor});
    return last_mapping_ = mappings_.size() - 1;
  }

  int to_host() const {
    const int descriptor = open_socket(host_.any.sa_family);
    if (descriptor >= 0 && connect(descriptor, &host_.any, host_.length) != 0) {
      close(descriptor);
      return -1;
    }
    return descriptor;
  }

  void renew_sockets() {
    for (Mapping& mapping : mappings_) {
      const int descriptor = to_host();
      if (descriptor < 0) continue;
      close(mapping.descriptor);
      mapping.descriptor = descriptor;
    }
  }

  void take(Way way, std::size_t mapping, std::size_t bytes) {
    const int index = static_cast<int>(way);
    Packet packet(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(bytes));
    const std::lock_guard lock(mutex_);
    if (captured_[index].size() < capture_) captured_[index].push_back(packet);
    if (tamper_) tamper_(way, packet);
    const Fate::Verdict verdict = fates_[index].judge(packet.size(), steady_now_ns());
    if (dark_ || packet.empty() || verdict.copies == 0 || waiting_.size() >= kWaiting) {
      ++stats_.dropped[index];
      return;
    }
    stats_.passed[index] += static_cast<std::uint64_t>(verdict.copies);
    for (int copy = 0; copy < verdict.copies; ++copy)
      waiting_.push({verdict.due_ns, order_++, way, mapping, packet});
  }

  void send_due() {
    const std::int64_t now = steady_now_ns();
    while (!waiting_.empty() && waiting_.top().due_ns <= now) {
      if (!dark_) send(waiting_.top().way, waiting_.top().mapping, waiting_.top().packet);
      waiting_.pop();
    }
  }

  void send_injected() {
    std::vector<std::pair<Way, Packet>> packets;
    {
      const std::lock_guard lock(mutex_);
      packets.swap(injected_);
    }
    for (const auto& [way, packet] : packets)
      if (last_mapping_ < mappings_.size()) send(way, last_mapping_, packet);
  }

  /// What the kernel does not take is lost, as on any link.
  void send(Way way, std::size_t mapping, const Packet& packet) {
    const Mapping& to = mappings_[mapping];
    if (way == Way::kUp) {
      if (::send(to.descriptor, packet.data(), packet.size(), 0) < 0 && errno == ECONNREFUSED)
        ::send(to.descriptor, packet.data(), packet.size(), 0);
    } else {
      sendto(listener_, packet.data(), packet.size(), 0, &to.peer.any, to.peer.length);
    }
  }

  const Address host_;
  const int listener_;
  const Address local_;
  const int wake_;
  std::atomic<bool> stop_ = false;
  std::atomic<bool> dark_ = false;
  std::atomic<bool> rebind_ = false;

  mutable std::mutex mutex_;  // of what follows
  Fate fates_[2];
  RelayStats stats_;
  std::size_t capture_ = 0;
  std::vector<Packet> captured_[2];
  std::vector<std::pair<Way, Packet>> injected_;
  std::function<void(Way, Packet&)> tamper_;

  // The thread's own.
  std::vector<Mapping> mappings_;
  std::size_t last_mapping_ = kMappings;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting_;
  std::uint64_t order_ = 0;
  std::array<std::uint8_t, 65536> buffer_;
  std::thread thread_;  // last: it starts when all else is there
};

}  // namespace

Result<std::unique_ptr<Relay>> Relay::start(const RelayOptions& options) {
  auto listen = quic::resolve(options.listen);
  if (!listen) return listen.error();
  auto to = quic::resolve(options.to);
  if (!to) return to.error();
  Address local = listen.value().front();
  const int descriptor = open_socket(local.any.sa_family);
  if (descriptor < 0 || bind(descriptor, &local.any, local.length) != 0) {
    const Error error{"address " + options.listen, std::strerror(errno), "Choose another address or port"};
    if (descriptor >= 0) close(descriptor);
    return error;
  }
  sockaddr_storage name{};
  socklen_t size = sizeof(name);
  getsockname(descriptor, reinterpret_cast<sockaddr*>(&name), &size);
  return std::unique_ptr<Relay>(std::make_unique<UdpRelay>(
      options, to.value().front(), descriptor, Address(reinterpret_cast<sockaddr*>(&name), size)));
}

}  // namespace slosh
