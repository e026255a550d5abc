// Plug-ins by name, as they are built for tests.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "peer/devices/plugin_device.h"
#include "tests/peer/devices/own_folder.h"
#include "tests/support/places.h"

namespace slosh::test {

inline std::string library(const std::string& name) {
  return (build_dir() / "lib" / (name + ".so")).string();
}

inline std::unique_ptr<PluginDevice> plugin(const std::string& name, const std::string& options = "") {
  return std::make_unique<PluginDevice>(library(name), options, HandPlace{});
}

class Plugins : public ::testing::Test {
 protected:
  // No settings of who runs the tests.
  void SetUp() override { setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1); }
  OwnFolder folder_;
};

}  // namespace slosh::test
