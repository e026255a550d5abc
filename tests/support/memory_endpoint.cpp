#include "tests/support/memory_endpoint.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <functional>

#include "net/clock.h"
#include "net/wire/messages.h"

namespace slosh {
namespace {

class MemoryEndpoint;

/// One direction of a connection.
struct Way {
  ConnectionId id = 0;  // as the end that sends here knows it
  MemoryEndpoint* from = nullptr;
  std::deque<SharedBytes> queues[kPriorities];
  ConnectionStats stats;
  std::int64_t free_at_ns = 0;   // when the rate lets the next datagram go
  std::int64_t received_ns = 0;  // when the sending end last heard from the other
  std::int64_t next_stream = 0;  // counts both kinds
};

struct Connection {
  Way ways[2];  // 0: from who connected, 1: from who listens
  MemoryLink link;
  bool dark = false;
  bool open = true;
};

struct Event {
  std::function<void(EndpointEvents&)> deliver;
};

}  // namespace

struct MemoryNetwork::Impl {
  mutable std::mutex mutex;
  std::condition_variable changed;
  MemoryClock clock;
  MemoryLink link;
  std::mt19937_64 random;
  std::int64_t manual_ns = to_nanoseconds(1000.0);
  MemoryEndpoint* listener = nullptr;

  std::int64_t now() const { return clock == MemoryClock::kManual ? manual_ns : steady_now_ns(); }
  void flush(Connection& c, int direction);
  void forget(MemoryEndpoint* end);
  void close(Connection& c, int by, std::uint64_t code, const std::string& text);
};

namespace {

class MemoryEndpoint final : public Endpoint {
 public:
  using Impl = MemoryNetwork::Impl;
  MemoryEndpoint(std::shared_ptr<Impl> network, EndpointEvents& events, const KeyFingerprint& key,
                 const EndpointOptions& options, std::string address)
      : network_(std::move(network)),
        events_(events),
        key_(key),
        options_(options),
        address_(std::move(address)) {}

  ~MemoryEndpoint() override {
    const std::lock_guard lock(network_->mutex);
    network_->forget(this);
  }

  void run_once(std::int64_t deadline_ns) override {
    std::unique_lock lock(network_->mutex);
    for (;;) {
      check_idle();
      for (auto& [id, entry] : mine_) network_->flush(*entry.connection, entry.direction);
      const std::int64_t now = network_->now();
      bool delivered = false;
      while (!events_due_.empty() && events_due_.begin()->first.first <= now) {
        const Event event = std::move(events_due_.begin()->second);
        events_due_.erase(events_due_.begin());
        lock.unlock();
        event.deliver(events_);
        lock.lock();
        delivered = true;
      }
      for (auto& [id, entry] : mine_) network_->flush(*entry.connection, entry.direction);
      network_->changed.notify_all();
      if (network_->clock == MemoryClock::kManual || delivered || woken_ || now >= deadline_ns) {
        woken_ = false;
        return;
      }
      std::int64_t until = std::min(deadline_ns, now + to_nanoseconds(0.005));
      if (!events_due_.empty()) until = std::min(until, events_due_.begin()->first.first);
      network_->changed.wait_for(lock, std::chrono::nanoseconds(std::max<std::int64_t>(until - now, 1000)));
    }
  }

  void wake() override {
    {
      const std::lock_guard lock(network_->mutex);
      woken_ = true;
    }
    network_->changed.notify_all();
  }

  bool send_datagram(ConnectionId id, Priority priority, SharedBytes bytes) override {
    const std::lock_guard lock(network_->mutex);
    const auto found = mine_.find(id);
    if (found == mine_.end() || !found->second.connection->open) return false;
    if (!bytes || bytes->size() > wire::kMaxDatagram) return false;
    Way& way = found->second.connection->ways[found->second.direction];
    const auto lane = static_cast<std::size_t>(priority);
    if (way.queues[lane].size() >= options_.queue_datagrams[lane]) {
      way.queues[lane].pop_front();
      way.stats.datagrams_dropped[lane] += 1;
    }
    way.queues[lane].push_back(std::move(bytes));
    network_->flush(*found->second.connection, found->second.direction);
    network_->changed.notify_all();
    return true;
  }

  std::int64_t open_stream(ConnectionId id, bool both_ways) override {
    const std::lock_guard lock(network_->mutex);
    const auto found = mine_.find(id);
    if (found == mine_.end() || !found->second.connection->open) return -1;
    Way& way = found->second.connection->ways[found->second.direction];
    return 4 * way.next_stream++ + (both_ways ? 0 : 2) + found->second.direction;
  }

  bool send_stream(ConnectionId id, std::int64_t stream, std::span<const std::uint8_t> bytes,
                   bool end) override {
    return send_shared(id, stream,
                       std::make_shared<const std::vector<std::uint8_t>>(bytes.begin(), bytes.end()), end);
  }
  bool send_shared(ConnectionId id, std::int64_t stream, SharedBytes bytes, bool end) override {
    const std::lock_guard lock(network_->mutex);
    const auto found = mine_.find(id);
    if (found == mine_.end() || !found->second.connection->open) return false;
    Connection& c = *found->second.connection;
    Way& way = c.ways[found->second.direction];
    Way& back = c.ways[1 - found->second.direction];
    way.stats.bytes_sent += bytes->size();
    if (c.dark || !back.from) return true;
    const ConnectionId there = back.id;
    back.from->add(network_->now() + to_nanoseconds(c.link.delay),
                   [there, stream, end, bytes = std::move(bytes)](EndpointEvents& events) {
                     events.on_stream(there, stream, *bytes, end);
                   });
    network_->changed.notify_all();
    return true;
  }

  void close(ConnectionId id, std::uint64_t code, const std::string& text) override {
    const std::lock_guard lock(network_->mutex);
    const auto found = mine_.find(id);
    if (found != mine_.end()) network_->close(*found->second.connection, found->second.direction, code, text);
    network_->changed.notify_all();
  }

  ConnectionStats stats(ConnectionId id) const override {
    const std::lock_guard lock(network_->mutex);
    const auto found = mine_.find(id);
    if (found == mine_.end()) return {};
    const Connection& c = *found->second.connection;
    ConnectionStats stats = c.ways[found->second.direction].stats;
    // What waits for a slow link is what makes a round trip longer.
    const double waiting =
        std::max(0.0, to_seconds(c.ways[found->second.direction].free_at_ns - network_->now()));
    stats.min_rtt = 2.0 * c.link.delay;
    stats.smoothed_rtt = stats.min_rtt + c.link.jitter + waiting;
    stats.delivery_rate = c.link.bytes_per_second;
    return stats;
  }
  EndpointStats endpoint_stats() const override {
    const std::lock_guard lock(network_->mutex);
    EndpointStats stats;
    for (const auto& [id, entry] : mine_) stats.connections += entry.connection->open ? 1 : 0;
    return stats;
  }
  std::string local_address() const override { return address_; }

  // The rest with the network's lock held.
  struct Entry {
    std::shared_ptr<Connection> connection;
    int direction = 0;
  };
  ConnectionId attach(const std::shared_ptr<Connection>& connection, int direction) {
    const ConnectionId id = next_id_++;
    mine_[id] = {connection, direction};
    Way& way = connection->ways[direction];
    way.id = id;
    way.from = this;
    way.received_ns = network_->now();
    return id;
  }
  void add(std::int64_t due_ns, std::function<void(EndpointEvents&)> deliver) {
    events_due_[{due_ns, sequence_++}] = {std::move(deliver)};
  }
  /// What has ended is told with everything that was on its way before it.
  void detach(ConnectionId id) { mine_.erase(id); }
  void check_idle() {
    const std::int64_t now = network_->now();
    for (auto& [id, entry] : mine_) {
      Connection& c = *entry.connection;
      Way& way = c.ways[entry.direction];
      if (!c.dark) way.received_ns = now;  // keep-alives pass
      if (c.open && now - way.received_ns > to_nanoseconds(options_.idle_timeout)) {
        c.open = false;
        for (Way& each : c.ways) {
          if (!each.from) continue;
          const ConnectionId gone = each.id;
          each.from->add(now, [gone](EndpointEvents& events) {
            events.on_closed(gone, {false, 0, "timed out", CloseCause::kTimedOut});
          });
          if (each.from != this) each.from->detach(gone);
        }
        mine_.erase(id);
        return check_idle();
      }
    }
  }
  const std::map<ConnectionId, Entry>& mine() const { return mine_; }
  const KeyFingerprint& key() const { return key_; }

 private:
  std::shared_ptr<Impl> network_;
  EndpointEvents& events_;
  KeyFingerprint key_;
  EndpointOptions options_;
  std::string address_;
  std::map<ConnectionId, Entry> mine_;
  std::map<std::pair<std::int64_t, std::uint64_t>, Event> events_due_;
  std::uint64_t sequence_ = 0;
  ConnectionId next_id_ = 1;
  bool woken_ = false;
};

}  // namespace

void MemoryNetwork::Impl::flush(Connection& c, int direction) {
  Way& way = c.ways[direction];
  Way& back = c.ways[1 - direction];
  const std::int64_t at = now();
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int lane = 0; lane < kPriorities; ++lane) {
    while (!way.queues[lane].empty()) {
      if (c.link.bytes_per_second > 0.0) {
        if (way.free_at_ns > at) return;
        const double takes = static_cast<double>(way.queues[lane].front()->size()) / c.link.bytes_per_second;
        way.free_at_ns = std::max(way.free_at_ns, at - to_nanoseconds(0.01)) + to_nanoseconds(takes);
      }
      SharedBytes bytes = std::move(way.queues[lane].front());
      way.queues[lane].pop_front();
      way.stats.datagrams_sent[lane] += 1;
      way.stats.bytes_sent += bytes->size();
      if (c.dark || !back.from || !c.open) continue;
      if (c.link.loss > 0.0 && share(random) < c.link.loss) {
        way.stats.datagrams_lost += 1;
        continue;
      }
      const ConnectionId there = back.id;
      back.stats.bytes_received += bytes->size();
      back.from->add(
          at + to_nanoseconds(c.link.delay + c.link.jitter * share(random)),
          [there, bytes = std::move(bytes)](EndpointEvents& events) { events.on_datagram(there, *bytes); });
    }
  }
}

void MemoryNetwork::Impl::close(Connection& c, int by, std::uint64_t code, const std::string& text) {
  if (!c.open) return;
  flush(c, by);
  c.open = false;
  for (int side = 0; side < 2; ++side) {
    Way& way = c.ways[side];
    if (!way.from) continue;
    const ConnectionId id = way.id;
    const bool by_peer = side != by;
    if (!(by_peer && c.dark)) {
      const double delay = by_peer ? c.link.delay + c.link.jitter : 0.0;  // behind every datagram
      way.from->add(now() + to_nanoseconds(delay), [id, by_peer, code, text](EndpointEvents& events) {
        events.on_closed(id, {by_peer, code, text});
      });
      way.from->detach(id);
    }
  }
}

void MemoryNetwork::Impl::forget(MemoryEndpoint* end) {
  if (listener == end) listener = nullptr;
  // Gone without a word, as a crashed program: the other end finds out by its idle timeout.
  for (const auto& [id, entry] : end->mine()) {
    entry.connection->ways[entry.direction].from = nullptr;
    entry.connection->dark = true;
  }
}

MemoryNetwork::MemoryNetwork(MemoryClock clock, const MemoryLink& link, std::uint64_t seed)
    : impl_(std::make_shared<Impl>()) {
  impl_->clock = clock;
  impl_->link = link;
  impl_->random.seed(seed);
}
MemoryNetwork::~MemoryNetwork() = default;

std::unique_ptr<Endpoint> MemoryNetwork::listen(EndpointEvents& events, const KeyFingerprint& key,
                                                const EndpointOptions& options) {
  auto end = std::make_unique<MemoryEndpoint>(impl_, events, key, options, "127.0.0.1:4433");
  const std::lock_guard lock(impl_->mutex);
  impl_->listener = end.get();
  return end;
}

std::unique_ptr<Endpoint> MemoryNetwork::connect(EndpointEvents& events, const KeyFingerprint& key,
                                                 const std::string& address, const EndpointOptions& options) {
  auto end = std::make_unique<MemoryEndpoint>(impl_, events, key, options, address);
  const std::lock_guard lock(impl_->mutex);
  auto connection = std::make_shared<Connection>();
  connection->link = impl_->link;
  const ConnectionId here = end->attach(connection, 0);
  const std::int64_t due = impl_->now() + to_nanoseconds(2.0 * connection->link.delay);
  if (!impl_->listener) {
    connection->open = false;
    end->add(due, [here](EndpointEvents& told) {
      told.on_closed(here, {false, 0, "nobody answers", CloseCause::kNoAnswer});
    });
    return end;
  }
  const KeyFingerprint host = impl_->listener->key();
  const ConnectionId there = impl_->listener->attach(connection, 1);
  end->add(due, [here, host](EndpointEvents& told) { told.on_connected(here, host, "127.0.0.1:4433"); });
  impl_->listener->add(
      due, [there, key, address](EndpointEvents& told) { told.on_connected(there, key, address); });
  impl_->changed.notify_all();
  return end;
}

std::int64_t MemoryNetwork::now_ns() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->now();
}

void MemoryNetwork::advance(double seconds) {
  const std::lock_guard lock(impl_->mutex);
  impl_->manual_ns += to_nanoseconds(seconds);
}

void MemoryNetwork::set_link(const MemoryLink& link) {
  const std::lock_guard lock(impl_->mutex);
  impl_->link = link;
  if (!impl_->listener) return;
  for (const auto& [id, entry] : impl_->listener->mine()) entry.connection->link = link;
}

void MemoryNetwork::set_link(const Endpoint& connected, const MemoryLink& link) {
  const std::lock_guard lock(impl_->mutex);
  for (const auto& [id, entry] : static_cast<const MemoryEndpoint&>(connected).mine())
    entry.connection->link = link;
}

void MemoryNetwork::set_dark(const Endpoint& connected, bool dark) {
  const std::lock_guard lock(impl_->mutex);
  for (const auto& [id, entry] : static_cast<const MemoryEndpoint&>(connected).mine())
    entry.connection->dark = dark;
}

}  // namespace slosh
