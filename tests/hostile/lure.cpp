// The hostile host by itself, for peers that another program starts: prints "TRICK<tab>LINK" for each guest
// that it is ready for, then does its harm until its standard input ends. Usage: hostile_lure GUESTS SEED
#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "scenes/load.h"
#include "tests/hostile/evil_host.h"

namespace {

bool input_ended() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  char ignored[256];
  return poll(&input, 1, 0) > 0 && read(STDIN_FILENO, ignored, sizeof ignored) <= 0;
}

}  // namespace

int main(int count, char** arguments) {
  using namespace slosh;
  const Result<std::filesystem::path> file = find_scene("probe");
  const Result<Scene> scene = file ? load_scene(file.value()) : Result<Scene>(file.error());
  if (count != 3 || !scene) {
    std::fprintf(stderr, "usage: hostile_lure GUESTS SEED%s\n",
                 scene ? "" : (", where the scene probe is: " + scene.error().text()).c_str());
    return 2;
  }
  hostile::EvilHost host(scene.value(), std::strtoull(arguments[2], nullptr, 10));
  if (!host.problem().empty()) {
    std::fprintf(stderr, "hostile_lure: %s\n", host.problem().c_str());
    return 1;
  }
  const std::uint64_t guests = std::strtoull(arguments[1], nullptr, 10);
  for (std::uint64_t guest = 0; guest < guests; ++guest)
    std::printf("%s\t%s\n", name_of(host.trick(guest)), host.link(guest).c_str());
  std::printf("\n");
  std::fflush(stdout);
  while (!input_ended()) host.turn();
  return 0;
}
