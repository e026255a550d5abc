// A scene from a stranger: what it may open, and what its names may do.
#include <arpa/inet.h>
#include <sys/inotify.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

#include "net/text/clean.h"
#include "support.h"

namespace slosh {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;

std::string bytes_of_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The bytes of a data URI that tinygltf wrote.
std::string base64_decoded(const std::string& uri) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  std::uint32_t bits = 0;
  int count = 0;
  for (std::size_t i = uri.find(',') + 1; i < uri.size() && uri[i] != '='; ++i) {
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(uri[i]));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out += static_cast<char>(bits >> count & 0xff);
  }
  return out;
}

/// Whether somebody opens files, as the kernel sees it.
class Openings {
 public:
  explicit Openings(const std::vector<fs::path>& files) : notify_(inotify_init1(IN_NONBLOCK)) {
    for (const fs::path& file : files)
      EXPECT_GE(inotify_add_watch(notify_, file.c_str(), IN_OPEN | IN_ACCESS), 0) << file;
  }
  ~Openings() { close(notify_); }
  bool any() const {
    char room[4096];
    return read(notify_, room, sizeof room) > 0;
  }

 private:
  int notify_;
};

/// A server of this machine that says nothing: whether anybody comes.
class Ear {
 public:
  Ear() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0)) {
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&here), sizeof here), 0);
    EXPECT_EQ(listen(socket_, 4), 0);
    socklen_t size = sizeof here;
    getsockname(socket_, reinterpret_cast<sockaddr*>(&here), &size);
    at_ = "127.0.0.1:" + std::to_string(ntohs(here.sin_port));
  }
  ~Ear() { close(socket_); }
  const std::string& at() const { return at_; }
  bool anybody() const {
    const int caller = accept(socket_, nullptr, nullptr);
    if (caller >= 0) close(caller);
    return caller >= 0;
  }

 private:
  int socket_;
  std::string at_;
};

/// The cup with its buffer in a file of its own: JSON and the file's bytes.
struct Cup {
  nlohmann::json json;
  std::string bytes;
};

Cup cup_in_two_files() {
  const TempFolder folder;
  EXPECT_TRUE(test::make_cup().write(folder / "cup.gltf"));
  Cup cup{test::read_json(folder / "cup.gltf"), {}};
  cup.bytes = base64_decoded(cup.json["buffers"][0]["uri"].get<std::string>());
  return cup;
}

Result<Scene> load_with_uri(const fs::path& scene, const std::string& uri) {
  Cup cup = cup_in_two_files();
  cup.json["buffers"][0]["uri"] = uri;
  test::write_text(scene, cup.json.dump());
  return load_scene(scene);
}

TEST(ForeignFile, ItsOwnFolderAndBelowMayHoldBuffers) {
  const TempFolder folder;
  const std::string bytes = cup_in_two_files().bytes;
  fs::create_directories(folder / "parts and more/deeper");
  test::write_text(folder / "cup.bin", bytes);
  test::write_text(folder / "parts and more/deeper/cup.bin", bytes);
  fs::create_symlink("parts and more", folder / "link");
  for (const char* uri : {"cup.bin", "./cup.bin", "parts%20and%20more/deeper/cup.bin",
                          "parts and more/../cup.bin", "link/deeper/cup.bin", "c%75p.bin"}) {
    const Result<Scene> scene = load_with_uri(folder / "cup.gltf", uri);
    EXPECT_TRUE(scene) << uri << ": " << (scene ? "" : scene.error().text());
  }
}

TEST(ForeignFile, NothingElseIsOpened) {
  const TempFolder outer;
  fs::create_directories(outer / "scene/below");
  fs::create_directories(outer / "scenery");
  // What is outside would be a perfect buffer, so that only the place can be the reason.
  const std::string bytes = cup_in_two_files().bytes;
  test::write_text(outer / "secret.bin", bytes);
  test::write_text(outer / "scenery/secret.bin", bytes);
  fs::create_symlink(outer / "secret.bin", outer / "scene/link.bin");
  fs::create_symlink(outer / "scenery", outer / "scene/below/elsewhere");
  const std::string secret = (outer / "secret.bin").string();
  for (const std::string& uri :
       {std::string("/etc/passwd"), secret, "file://" + secret, std::string("../secret.bin"),
        std::string("below/../../secret.bin"), std::string("%2e%2e/secret.bin"),
        std::string("..%2fsecret.bin"), std::string("%2e%2e%2Fsecret.bin"), std::string("link.bin"),
        std::string("below/elsewhere/secret.bin"), std::string("../scenery/secret.bin"),
        std::string("http://127.0.0.1/secret.bin"), "%00" + secret, "%2F" + secret.substr(1)}) {
    const Result<Scene> scene = load_with_uri(outer / "scene/cup.gltf", uri);
    ASSERT_FALSE(scene) << uri;
    EXPECT_NE(scene.error().where.find("buffer 0"), std::string::npos) << scene.error().text();
    EXPECT_NE(scene.error().mend.find("folder below it"), std::string::npos) << scene.error().text();
  }
}

TEST(ForeignFile, APictureIsHeldToTheSame) {
  const TempFolder outer;
  fs::create_directories(outer / "scene");
  test::write_text(outer / "secret.png", "\x89PNG");
  test::write_text(outer / "scene/own.png", "\x89PNG");
  fs::create_symlink(outer / "secret.png", outer / "scene/link.png");
  ASSERT_EQ(mkfifo((outer / "scene/pipe.png").c_str(), 0600), 0);  // who opened it would wait for ever
  const Ear ear;
  const std::string secret = (outer / "secret.png").string();
  for (const std::string& uri :
       {std::string("/etc/passwd"), secret, "file://" + secret, std::string("../secret.png"),
        std::string("link.png"), std::string("own.png"), std::string("pipe.png"),
        std::string("%2e%2e/secret.png"), "http://" + ear.at() + "/a.png", "https://" + ear.at() + "/a.png",
        "//" + ear.at() + "/a.png", std::string("data:image/png;base64,AAAA")}) {
    nlohmann::json file;
    ASSERT_TRUE(test::make_cup().write(outer / "scene/cup.gltf"));
    file = test::read_json(outer / "scene/cup.gltf");
    file["images"] = nlohmann::json::array({{{"uri", uri}}});
    file["textures"] = nlohmann::json::array({{{"source", 0}}});
    file["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    test::write_text(outer / "scene/cup.gltf", file.dump());
    const Openings openings({outer / "secret.png", outer / "scene/pipe.png"});
    const Openings own({outer / "scene/own.png"});
    const Result<Scene> scene = load_scene(outer / "scene/cup.gltf");
    ASSERT_TRUE(scene) << uri << ": " << scene.error().text();
    EXPECT_FALSE(openings.any()) << uri;
    EXPECT_EQ(own.any(), uri == "own.png") << uri;
    EXPECT_FALSE(ear.anybody()) << uri;
    // None of them is a picture: one sentence, and the scene without it.
    ASSERT_EQ(scene.value().left_out.size(), 1u) << uri;
    EXPECT_NE(scene.value().left_out[0].where.find("image"), std::string::npos)
        << scene.value().left_out[0].text();
    EXPECT_TRUE(scene.value().images.empty()) << uri;
    EXPECT_FALSE(scene.value().bodies[0].material.maps.any()) << uri;
  }
  // It would be seen.
  const Openings openings({outer / "secret.png"});
  bytes_of_file(outer / "secret.png");
  EXPECT_TRUE(openings.any());
}

TEST(ForeignFile, WhatIsNoFileIsNotOpened) {
  const TempFolder folder;
  fs::create_directories(folder / "dir.bin");
  ASSERT_EQ(mkfifo((folder / "pipe.bin").c_str(), 0600), 0);
  test::expect_error(load_with_uri(folder / "cup.gltf", "dir.bin"), {"buffer 0", "not a file"});
  test::expect_error(load_with_uri(folder / "cup.gltf", "pipe.bin"), {"buffer 0", "not a file"});
  test::expect_error(load_with_uri(folder / "cup.gltf", "nothing.bin"), {"buffer 0", "no such file"});
  test::expect_error(load_with_uri(folder / "cup.gltf", "$(touch x)`touch y`.bin"),
                     {"buffer 0", "no such file"});
}

TEST(ForeignFile, TheWorkingFolderIsNotSearched) {
  const TempFolder here;
  const TempFolder scene;
  test::write_text(here / "cup.bin", cup_in_two_files().bytes);
  const fs::path before = fs::current_path();
  fs::current_path(here / ".");
  test::expect_error(load_with_uri(scene / "cup.gltf", "cup.bin"), {"no such file"});
  fs::current_path(before);
}

TEST(ForeignFile, ABinaryFileIsHeldToTheSame) {
  const TempFolder folder;
  ASSERT_TRUE(test::make_cup().write(folder / "cup.glb"));
  const std::string bytes = bytes_of_file(folder / "cup.glb");
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  };
  nlohmann::json file = nlohmann::json::parse(bytes.substr(20, word(12)));
  file["buffers"].push_back({{"uri", "/etc/passwd"}, {"byteLength", fs::file_size("/etc/passwd")}});
  std::string text = file.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string changed = bytes.substr(0, 12);
  const auto append = [&](std::uint32_t value) { changed.append(reinterpret_cast<const char*>(&value), 4); };
  append(static_cast<std::uint32_t>(text.size()));
  changed += bytes.substr(16, 4) + text + bytes.substr(20 + word(12));
  const auto total = static_cast<std::uint32_t>(changed.size());
  std::memcpy(changed.data() + 8, &total, 4);
  test::write_text(folder / "cup.glb", changed);
  test::expect_error(load_scene(folder / "cup.glb"), {"buffer 1", "/etc/passwd", "own folder"});
}

TEST(ForeignFile, EveryNameIsCleaned) {
  const TempFolder folder;
  nlohmann::json file;
  {
    ASSERT_TRUE(test::make_cup({{"title", "a\x1b[2Jcup\u009b31m\n"}}).write(folder / "cup.gltf"));
    file = test::read_json(folder / "cup.gltf");
  }
  test::node_named(file, "cup")["name"] = "c\u202eup\x07";
  test::node_named(file, "water")["extras"]["fluid"] = "\x1b]0;sour\x07";
  test::node_named(file, "water")["name"] = "wa\u200bter";
  test::node_named(file, "hand")["extras"]["grip"] = "`\x1b[31mgrip`";
  test::node_named(file, "handle")["name"] = "`\x1b[31mgrip`";
  test::write_text(folder / "cup.gltf", file.dump());
  const Result<Scene> loaded = load_scene(folder / "cup.gltf");
  ASSERT_TRUE(loaded) << loaded.error().text();
  const Scene& scene = loaded.value();
  EXPECT_EQ(scene.title, "a?[2Jcup?31m?");
  EXPECT_EQ(scene.bodies[0].name, "cup?");
  EXPECT_EQ(scene.fluid_volumes[0].name, "water");
  EXPECT_EQ(scene.fluids[0].name, "?]0;sour?");
  EXPECT_EQ(scene.grips[0].name, "`?[31mgrip`") << "what a shell would obey is only text here";
  EXPECT_FALSE(scene.grips[0].hand_motion.empty()) << "both ends of a reference are cleaned alike";
}

TEST(ForeignFile, ErrorsCanBeShown) {
  const TempFolder folder;
  test::write_text(folder / "a\x1b[2J.gltf", "{\"\u009b\x1b");
  test::write_text(folder / "b.gltf", "\xff\x1b[2J");
  for (const char* name : {"a\x1b[2J.gltf", "b.gltf", "\u009bnowhere.gltf"}) {
    const Result<Scene> scene = load_scene(folder / name);
    ASSERT_FALSE(scene);
    EXPECT_EQ(text_problem(scene.error().text()), "") << clean_text(scene.error().text(), 1000);
  }
  const Result<Scene> unknown = test::load_edited(
      [](nlohmann::json& file) { test::node_named(file, "cup")["extras"]["mas\x1b_kg"] = 1; });
  ASSERT_FALSE(unknown);
  EXPECT_EQ(text_problem(unknown.error().text()), "");
}

}  // namespace
}  // namespace slosh
