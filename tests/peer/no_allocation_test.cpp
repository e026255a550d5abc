// The device loop's tick must not allocate: every operator new of this program is counted.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "peer/haptics/mouse_device.h"
#include "peer/haptics/script_device.h"
#include "servo_kit.h"

namespace {

thread_local std::size_t allocations = 0;

void* counted(std::size_t bytes) {
  allocations += 1;
  void* memory = std::malloc(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t bytes) {
  return counted(bytes);
}
void* operator new[](std::size_t bytes) {
  return counted(bytes);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace slosh {
namespace {

TEST(NoAllocation, TheCounterCounts) {
  const std::size_t before = allocations;
  delete new int(3);
  EXPECT_GT(allocations, before);
}

TEST(NoAllocation, ATickOfEveryDeviceKindAllocatesNothing) {
  Scene scene = test::one_grip_scene();
  scene.grips.push_back(scene.grips[0]);
  std::vector<PoseKey> keys(3);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    keys[i].time = 0.2 * static_cast<double>(i);
    keys[i].pose.position.x = 0.1 * static_cast<double>(i * i);
  }
  auto target = std::make_shared<MouseTarget>(Pose{});
  std::vector<std::unique_ptr<Device>> devices;
  devices.push_back(std::make_unique<TrackDevice>(PoseTrack(keys, Pose{}), "script"));
  devices.push_back(std::make_unique<MouseDevice>(target, Pose{}));
  BodyMessage first;
  first.time_step = 0.001;
  first.bodies.grips.resize(2);
  Channel channel(2, first, 1 << 20);
  ServoOptions options;
  options.sample_capacity = 16;  // it fills up: a full ring must not allocate either
  Servo servo(scene, std::move(devices), channel, options);

  const std::size_t before = allocations;
  for (int i = 0; i < 1000; ++i) {
    BodyMessage& message = channel.bodies().back();
    message.stamp_ns = i * 1'000'000;
    message.rate = 1.0;
    message.bodies.tick = static_cast<std::uint64_t>(i);
    message.bodies.time = 0.001 * i;
    channel.bodies().publish();
    servo.tick(i * 1'000'000 + 300'000);
  }
  EXPECT_EQ(allocations, before);
  EXPECT_GT(servo.samples_lost(), 0u);
}

}  // namespace
}  // namespace slosh
