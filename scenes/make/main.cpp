// slosh-make-scenes FOLDER [--glb]: writes the shipped scenes.
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "scenes/make/shipped.h"

namespace {

struct Shipped {
  const char* name;
  slosh::make::SceneWriter (*make)();
};

constexpr Shipped kShipped[] = {
    {"bucket", slosh::make::make_bucket}, {"spoon", slosh::make::make_spoon},
    {"pour", slosh::make::make_pour},     {"spin", slosh::make::make_spin},
    {"pool", slosh::make::make_pool},     {"probe", slosh::make::make_probe},
    {"crepe", slosh::make::make_crepe},   {"mixer", slosh::make::make_mixer},
    {"vessel", slosh::make::make_vessel},
};

}  // namespace

int main(int argc, char** argv) {
  const bool binary = argc == 3 && std::strcmp(argv[2], "--glb") == 0;
  if (argc != 2 && !binary) {
    std::fprintf(stderr, "usage: slosh-make-scenes FOLDER [--glb]\n");
    return 2;
  }
  const std::filesystem::path folder(argv[1]);
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  for (const Shipped& scene : kShipped) {
    const std::filesystem::path file = folder / (std::string(scene.name) + (binary ? ".glb" : ".gltf"));
    if (!scene.make().write(file)) {
      std::fprintf(stderr, "%s: cannot be written: is there room, and may you write there?\n",
                   file.string().c_str());
      return 1;
    }
  }
  return 0;
}
