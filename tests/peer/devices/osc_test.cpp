// Trackers over Open Sound Control, by the plug-in as it is built, told of by liblo, which knows nothing of
// ours.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <lo/lo.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <set>
#include <thread>

#include "peer/devices/hardware.h"
#include "peer/devices/plugin_device.h"
#include "tests/peer/devices/own_folder.h"
#include "tests/support/comes.h"
#include "tests/support/places.h"

namespace slosh {
namespace {

constexpr double kRight = 1e-6;  // m and rad: floats travel

/// A socket of loopback, and the port that it has.
struct Socket {
  Socket() : descriptor(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    bind(descriptor, reinterpret_cast<const sockaddr*>(&at), sizeof at);
    getsockname(descriptor, reinterpret_cast<sockaddr*>(&at), &size);
    port = ntohs(at.sin_port);
  }
  ~Socket() { close(descriptor); }
  Socket(const Socket&) = delete;
  void send(int to, const void* bytes, std::size_t size) const {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    at.sin_port = htons(static_cast<std::uint16_t>(to));
    sendto(descriptor, bytes, size, 0, reinterpret_cast<const sockaddr*>(&at), sizeof at);
  }
  int descriptor;
  int port;
};

int free_port() {
  return Socket().port;
}

std::unique_ptr<PluginDevice> tracker(const std::string& options) {
  return std::make_unique<PluginDevice>((test::build_dir() / "lib" / "slosh_osc_device.so").string(), options,
                                        HandPlace{});
}

class OscTracker : public ::testing::Test {
 protected:
  // No settings of who runs the tests.
  void SetUp() override { setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1); }
  void TearDown() override {
    if (device_) device_->close();
    if (sender_ != nullptr) lo_address_free(sender_);
  }
  void open(const std::string& with) {
    port_ = free_port();
    device_ = tracker(std::to_string(port_) + with);
    const Result<bool> opened = open_device(*device_);
    ASSERT_TRUE(opened) << opened.error().text();
    sender_ = lo_address_new("127.0.0.1", std::to_string(port_).c_str());
  }
  DeviceReport read() {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return device_->read({0.0, 0.001});
  }
  /// Sends again and again, as trackers do, until the hand is there.
  template <class Send>
  void settles(Send&& send, const glm::dvec3& place, const glm::dvec3& turned = glm::dvec3(0.0)) {
    DeviceReport last;
    EXPECT_TRUE(test::comes([&] {
      send();
      last = read();
      return last.heard && glm::length(last.pose.position - place) < kRight &&
             glm::length(rotation_between({1.0, 0.0, 0.0, 0.0}, last.pose.orientation) - turned) < kRight;
    })) << last.pose.position.x
        << " " << last.pose.position.y << " " << last.pose.position.z << ", " << device_->trouble();
    EXPECT_TRUE(is_sound(last));
  }
  /// Sends until its words have this.
  template <class Send>
  void says(Send&& send, const std::string& words) {
    std::string said;
    EXPECT_TRUE(test::comes([&] {
      send();
      (void)read();
      said = device_->trouble() + device_->status();
      return said.find(words) != std::string::npos;
    })) << said
        << "\nwanted: " << words;
  }
  test::OwnFolder folder_;
  int port_ = 0;
  std::unique_ptr<PluginDevice> device_;
  lo_address sender_ = nullptr;
};

constexpr double kQuarter = 1.5707963267948966;

// VRChat's form is Unity's frame: x to the right, y up, z away from the user, degrees.
TEST_F(OscTracker, ThatMovesByFiveCentimetresMovesTheHandByFive) {
  open(",vrchat=1");
  EXPECT_FALSE(device_->gives_way()) << "it gives no force";
  const auto at = [&](float x, float y, float z, float yaw) {
    lo_send(sender_, "/tracking/trackers/1/position", "fff", x, y, z);
    lo_send(sender_, "/tracking/trackers/1/rotation", "fff", 0.0f, yaw, 0.0f);
  };
  settles([&] { at(0.3f, 1.2f, -0.4f, 0.0f); }, glm::dvec3(0.0));  // the hand begins where it is
  settles([&] { at(0.35f, 1.2f, -0.4f, 0.0f); }, {0.05, 0.0, 0.0});
  settles([&] { at(0.35f, 1.25f, -0.35f, 0.0f); }, {0.05, 0.05, -0.05});
  // Turned to the right, seen from above: about -y in a right-handed frame.
  settles([&] { at(0.35f, 1.25f, -0.35f, 90.0f); }, {0.05, 0.05, -0.05}, {0.0, -kQuarter, 0.0});
}

TEST_F(OscTracker, IsFoundByItsSerialNumberInABundleWhateverTheBundlesTime) {
  open(",vmc=LHR-1");
  const auto send = [&](float x) {
    lo_bundle bundle = lo_bundle_new({0xffffffffu, 0});  // in the year 2036
    for (const char* serial : {"LHR-0", "LHR-1", "LHR-2"}) {
      lo_message m = lo_message_new();
      const bool ours = std::strcmp(serial, "LHR-1") == 0;
      lo_message_add(m, "sfffffff", serial, ours ? x : 9.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f);
      lo_bundle_add_message(bundle, "/VMC/Ext/Tra/Pos", m);
    }
    lo_send_bundle(sender_, bundle);
    lo_bundle_free_recursive(bundle);
  };
  settles([&] { send(1.0f); }, glm::dvec3(0.0));
  settles([&] { send(1.05f); }, {0.05, 0.0, 0.0});
}

// A phone's pose: right-handed, a quaternion x y z w in a message of its own.
TEST_F(OscTracker, OfAPhone) {
  open(",zigsim=phone");
  const auto send = [&](float z, float qz, float qw) {
    lo_send(sender_, "/phone/arkitposition", "fff", 0.0f, 0.0f, z);
    lo_send(sender_, "/phone/arkitrotation", "ffff", 0.0f, 0.0f, qz, qw);
  };
  settles([&] { send(0.0f, 0.0f, 1.0f); }, glm::dvec3(0.0));
  settles([&] { send(0.05f, 0.70710678f, 0.70710678f); }, {0.0, 0.0, 0.05}, {0.0, 0.0, kQuarter});
}

TEST_F(OscTracker, MayHaveAnyAddressUnitAndKindOfNumber) {
  open(",pose=/my/hand,serial=7,unit=cm,frame=unity");
  const auto send = [&](int x) {
    lo_send(sender_, "/my/hand", "iiiidddd", 7, x, 0, 0, 0.0, 0.0, 0.0, 1.0);
    lo_send(sender_, "/my/hand", "iiiidddd", 8, 50, 0, 0, 0.0, 0.0, 0.0, 1.0);
  };
  settles([&] { send(0); }, glm::dvec3(0.0));
  settles([&] { send(5); }, {0.05, 0.0, 0.0});
}

// One sender tells of both hands: they share its port.
TEST_F(OscTracker, OfTwoHandsShareAPort) {
  open(",vrchat=1");
  auto other = tracker(std::to_string(port_) + ",vrchat=2");
  const Result<bool> opened = open_device(*other);
  ASSERT_TRUE(opened) << opened.error().text();
  DeviceReport last;
  const auto send = [&](float one, float two) {
    lo_send(sender_, "/tracking/trackers/1/position", "fff", one, 0.0f, 0.0f);
    lo_send(sender_, "/tracking/trackers/2/position", "fff", two, 0.0f, 0.0f);
    last = other->read({0.0, 0.001});
  };
  settles([&] { send(0.0f, 0.0f); }, glm::dvec3(0.0));
  EXPECT_TRUE(test::comes([&] { return send(0.0f, 0.0f), last.heard; }));
  settles([&] { send(0.05f, -0.02f); }, {0.05, 0.0, 0.0});
  EXPECT_TRUE(
      test::comes([&] { return send(0.05f, -0.02f), std::abs(last.pose.position.x + 0.02) < kRight; }));
  other->close();
  settles([&] { lo_send(sender_, "/tracking/trackers/1/position", "fff", 0.06f, 0.0f, 0.0f); },
          {0.06, 0.0, 0.0});
}

// Words that come each fiftieth tick: the hand goes on between them, and says its speed.
TEST_F(OscTracker, GoesOnBetweenItsWords) {
  open("");
  std::set<double> places;
  int faster = 0;
  constexpr int kWords = 20;
  for (int i = 0; i < 50 * kWords; ++i) {
    if (i % 50 == 0)
      lo_send(sender_, "/slosh/hand/pose", "fffffff", 0.001f * static_cast<float>(i), 0.0f, 0.0f, 0.0f, 0.0f,
              0.0f, 1.0f);
    const DeviceReport report = read();
    if (!report.heard) continue;
    places.insert(report.pose.position.x);
    faster += report.twist.linear.x > 0.0 ? 1 : 0;
  }
  EXPECT_GT(places.size(), 5u * kWords);
  EXPECT_GT(faster, 5 * kWords);
}

TEST_F(OscTracker, SaysWhatIsWrongWithWhatComes) {
  open(",pose=/a,serial=1");
  const Socket raw;
  const auto nothing = [] {};
  const auto bytes = [&](const std::string& text) {
    return [&, text] { raw.send(port_, text.data(), text.size()); };
  };
  const std::string place = "listening at 127.0.0.1:" + std::to_string(port_) + " for /a of '1'; ";
  says(nothing, place + "nothing has come");
  says(bytes("hello"), place + "what came is no OSC");
  says(bytes(std::string("/a\0\0,f\0\0\0\0", 10)), place + "what came is cut short in a message's arguments");
  says(bytes(std::string("#bundle\0\0\0\0\0\0\0\0\0\0\0\0\x40", 20)),
       place + "what came is cut short in a bundle");
  says(bytes(std::string("/a\0\0,b\0\0", 8)), place + "what came is cut short in a message's arguments");
  std::string nested = std::string("/a\0\0,\0\0\0", 8);
  for (int depth = 0; depth < 5; ++depth)
    nested = std::string("#bundle\0\0\0\0\0\0\0\0\1\0\0\0", 19) + static_cast<char>(nested.size()) + nested;
  says(bytes(nested), place + "what came has too many bundles in bundles");
  says([&] { lo_send(sender_, "/b", "f", 1.0f); }, "messages came that are none of it, the last /b");
  says([&] { lo_send(sender_, "/a", "if", 1, 1.0f); },
       "/a came with arguments of the types 'if', and its last 7 should be numbers");
  says([&] { lo_send(sender_, "/a", "isffffff", 1, "x", 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f); },
       "of the types 'isffffff'");
  const auto pose = [&](float x, float w) {
    lo_send(sender_, "/a", "ifffffff", 1, x, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, w);
  };
  says([&] { pose(std::numeric_limits<float>::quiet_NaN(), 1.0f); }, "a number that is not finite");
  says([&] { pose(0.0f, 0.3f); }, "a rotation (x y z w) of length 0.3 in place of 1");
  says([&] { pose(5000.0f, 1.0f); }, "a place 5000 m away: is its unit another?");
  EXPECT_FALSE(read().heard) << "nothing of it moved the hand";
  settles([&] { pose(0.0f, 1.0f); }, glm::dvec3(0.0));
  EXPECT_TRUE(test::comes([&] { return pose(0.0f, 1.0f), (void)read(), device_->trouble().empty(); }));
  says(nothing, "the tracker is silent for");
  EXPECT_FALSE(read().heard);
  settles([&] { pose(0.05f, 1.0f); }, {0.05, 0.0, 0.0});
}

// A packet damaged in each way that chance has: what moves the hand stays a pose.
TEST_F(OscTracker, OutlivesDamage) {
  open(",vmc=1");
  lo_bundle bundle = lo_bundle_new(LO_TT_IMMEDIATE);
  lo_message m = lo_message_new();
  lo_message_add(m, "sfffffff", "1", 0.1f, 0.2f, 0.3f, 0.0f, 0.0f, 0.0f, 1.0f);
  lo_bundle_add_message(bundle, "/VMC/Ext/Tra/Pos", m);
  std::size_t size = 0;
  auto* const whole = static_cast<unsigned char*>(lo_bundle_serialise(bundle, nullptr, &size));
  const Socket raw;
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::vector<unsigned char> packet(whole, whole + size);
    for (int n = static_cast<int>(random() % 3); n >= 0; --n)
      packet[random() % size] = static_cast<unsigned char>(random());
    if (random() % 3 == 0) packet.resize(random() % size);
    raw.send(port_, packet.data(), packet.size());
    if (i % 20 == 0) {
      const DeviceReport report = device_->read({0.0, 0.001});
      EXPECT_TRUE(!report.heard || is_sound(report));
    }
  }
  free(whole);
  lo_bundle_free_recursive(bundle);
}

TEST_F(OscTracker, RefusesWhatCannotBeAskedForInWords) {
  const Socket taken;
  for (const auto& [options, words] :
       {std::pair{std::to_string(taken.port),
                  std::string("cannot be listened at (Address already in use): end the program")},
        {"192.0.2.1:9000", "give an address of this machine"},
        {"nowhere:9000", "'nowhere:9000' is no port"},
        {"99999", "'99999' is no port"},
        {"9000,vrchat=1,colour=red", "'colour' is none of vrchat="},
        {"9000,pose=hand", "'pose' cannot be 'hand' (addresses begin with '/'"},
        {"9000,unit=inch", "'unit' cannot be 'inch'"},
        {"9000,rotation=/r", "a rotation alone is no place"}}) {
    const Result<bool> opened = open_device(*tracker(options));
    ASSERT_FALSE(opened) << options;
    EXPECT_NE(opened.error().text().find(words), std::string::npos) << opened.error().text();
  }
}

TEST_F(OscTracker, HasANameOfItsOwnForTheUser) {
  auto made = make_hardware("osc:" + std::to_string(free_port()), HandPlace{});
  ASSERT_TRUE(made.has_value());
  ASSERT_TRUE(*made) << made->error().text();
  Device& device = *made->value();
  EXPECT_TRUE(open_device(device));
  device.close();
}

}  // namespace
}  // namespace slosh
