#include "peer/remote/remote_visit.h"

#include <pthread.h>

namespace slosh {

RemoteVisit::RemoteVisit(RemoteOptions options, Connect connect)
    : link_(std::move(options), std::move(connect), shared_) {
  thread_ = std::thread([this] {
    pthread_setname_np(pthread_self(), "slosh-network");
    while (!stop_.load(std::memory_order_relaxed)) {
      if (!link_.turn()) return;
    }
    link_.leave("left");
  });
}

RemoteVisit::~RemoteVisit() {
  stop();
}

void RemoteVisit::stop() {
  stop_.store(true, std::memory_order_relaxed);
  link_.wake();
  if (thread_.joinable()) thread_.join();
  if (link_.world().maker) link_.world().maker->finish();
}

RemoteStatus RemoteVisit::status() const {
  const std::lock_guard lock(shared_.mutex);
  return shared_.status;
}

LinkState RemoteVisit::wait_until_live(std::chrono::milliseconds patience) {
  std::unique_lock lock(shared_.mutex);
  shared_.changed.wait_for(lock, patience, [this] {
    return shared_.status.state == LinkState::kLive || shared_.status.state == LinkState::kEnded;
  });
  return shared_.status.state;
}

std::vector<std::string> RemoteVisit::take_notices() {
  const std::lock_guard lock(shared_.mutex);
  return std::exchange(shared_.notices, {});
}

void RemoteVisit::ask(const RemoteCommand& command) {
  {
    const std::lock_guard lock(shared_.mutex);
    shared_.commands.push_back(command);
  }
  link_.wake();
}

Connect connect_by(const JoinLink& link, const Identity& identity) {
  return [link, identity](EndpointEvents& events, const EndpointOptions& options) {
    return connect_quic(link.addresses, link.host, identity, events, options);
  };
}

}  // namespace slosh
