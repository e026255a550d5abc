// A plug-in with one fault, by what it is compiled with. What it does while it is held it does from when it
// is told to (faulty_now), and says when that was and what it was sent.
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "peer/devices/plugin/slosh_device.h"

namespace {
[[maybe_unused]] int reads = 0;
[[maybe_unused]] void never_return() {
  for (;;) pause();
}
}  // namespace

extern "C" {

std::atomic<bool> faulty_now{false};
std::atomic<std::int64_t> faulty_since_ns{0};  // steady clock; 0 = not yet
std::atomic<double> faulty_force{0.0};         // N, along x, of the newest write
}

namespace {
/// Whether it goes wrong in this call.
[[maybe_unused]] bool goes_wrong() {
  if (!faulty_now) return false;
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  std::int64_t none = 0;
  faulty_since_ns.compare_exchange_strong(none, std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec);
  return true;
}
}  // namespace

extern "C" {

uint32_t slosh_device_version(void) {
#ifdef OTHER_VERSION
  return SLOSH_DEVICE_VERSION + 1;
#elif defined(VERSION_ONE)
  return 1;
#else
  return SLOSH_DEVICE_VERSION;
#endif
}

int slosh_device_open(const char*, void** device, char* error, size_t size) {
#ifdef THROWS_IN_OPEN
  throw std::runtime_error("no licence");
#endif
#ifdef BLOCKS_IN_OPEN
  never_return();
#endif
  std::snprintf(error, size, "%s", "");
  reads = 0;
  faulty_now = false;
  faulty_since_ns = 0;
  faulty_force = 0.0;
  static int one = 0;
  *device = &one;
  return 0;
}

int slosh_device_get_capabilities(void*, slosh_device_capabilities* c) {
#ifdef THROWS_IN_CAPABILITIES
  throw std::runtime_error("no data sheet");
#endif
#ifdef BLOCKS_IN_CAPABILITIES
  never_return();
#endif
  std::memset(c, 0, sizeof *c);
  std::snprintf(c->name, sizeof c->name, "faulty");
  c->period_s = 0.001;
  c->max_force_n = c->max_torque_nm = c->max_force_rate_n_s = c->max_torque_rate_nm_s = 100.0;
  c->max_stiffness_n_m = c->max_damping_n_s_m = 1000.0;
  c->max_rotational_stiffness_nm_rad = c->max_rotational_damping_nm_s_rad = 1.0;
  c->own_damping_n_s_m = c->own_rotational_damping_nm_s_rad = 1.0;
  c->workspace_radius_m = 0.1;
#ifdef ADMITTANCE
  c->kind = SLOSH_DEVICE_ADMITTANCE;
  c->virtual_mass_kg = c->virtual_inertia_kg_m2 = c->max_turning_rad_s = 1.0;
  c->max_speed_m_s = 0.1;
  c->following_s = 0.005;  // so that what it is told stays within 1 mm of where it is
#endif
#ifdef VERSION_ONE
  // Its fields end with the workspace's radius.
  std::memset(&c->kind, 0, sizeof *c - offsetof(slosh_device_capabilities, kind));
#endif
#ifdef NO_SPEED
  c->max_speed_m_s = 0.0;
#endif
#ifdef NAN_CAPABILITY
  c->max_force_n = std::nan("");
#endif
  return 0;
}

int slosh_device_read(void*, slosh_device_reading* reading) {
  std::memset(reading, 0, sizeof *reading);
  reading->orientation_wxyz[0] = 1.0;
  ++reads;
  // In place at first, so that the hand takes hold, then off by 10 mm, so that it feels a force.
  reading->position_m[0] = reads > 20 ? 0.01 : 0.0;
#ifdef THROWS_IN_READ
  if (goes_wrong()) throw std::runtime_error("the cable is out");
#endif
#ifdef ADMITTANCE
  reading->flags = SLOSH_READING_HAS_WRENCH;
#endif
#ifdef NAN_FORCE
  if (goes_wrong()) reading->force_n[2] = std::nan("");
#endif
#ifdef BLOCKS_IN_READ
  if (goes_wrong()) never_return();
#endif
#ifdef NAN_READING
  if (goes_wrong()) reading->position_m[1] = std::nan("");
#endif
#ifdef GONE
  if (goes_wrong()) return -1;
#endif
  return 0;
}

#ifndef LACKS_WRITE
int slosh_device_write(void*, const double force_n[3], const double[3]) {
#ifdef THROWS_IN_WRITE
  if (goes_wrong()) throw 7;
#endif
#ifdef BLOCKS_IN_WRITE
  if (goes_wrong()) never_return();
#endif
  faulty_force = force_n[0];
  return 0;
}
#endif

#if defined(ADMITTANCE) && !defined(LACKS_MOVE)
int slosh_device_move(void*, const slosh_device_motion*) {
#ifdef THROWS_IN_MOVE
  if (goes_wrong()) throw 7;
#endif
#ifdef BLOCKS_IN_MOVE
  if (goes_wrong()) never_return();
#endif
  return 0;
}
#endif

void slosh_device_close(void*) {
#ifdef THROWS_IN_CLOSE
  throw std::runtime_error("it is in use");
#endif
#ifdef BLOCKS_IN_CLOSE
  never_return();
#endif
}
}
