// What the tests of the server share: hosts whose world runs, and hosts whose world waits for a hand.
#pragma once

#include "host/server/server.h"
#include "tests/host/server/scripted_peer.h"

namespace slosh {

inline ServerOptions running() {
  ServerOptions options;
  options.hands_to_start = 0;
  return options;
}

class ServerTest : public ServedTest {
 protected:
  ServerTest() : ServedTest(running()) {}
};

class WaitingServerTest : public ServedTest {};

}  // namespace slosh
