// Files that are missing, broken or cut off: an error, never a crash.
#include <fstream>
#include <functional>
#include <iterator>
#include <random>

#include "support.h"

namespace slosh {
namespace {

using test::TempFolder;

std::string read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(FileErrors, Missing) {
  test::expect_error(load_scene("no/such/place.gltf"), {"no/such/place.gltf", "no such file"});
}

TEST(FileErrors, Folder) {
  test::expect_error(load_scene(std::filesystem::temp_directory_path()), {"not a file"});
}

TEST(FileErrors, Text) {
  const TempFolder folder;
  const char* const texts[] = {"",
                               "{",
                               "hello",
                               "[1, 2]",
                               "{\"asset\": {\"version\": \"1.0\"}, \"nodes\": [{\"mass\": NaN}]}",
                               "{\"asset\": 3}",
                               "{}",
                               "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": 5}",
                               "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [5]}",
                               "{\"a\": 1e999}",
                               "\xff\xfe\x01"};
  for (const char* text : texts) {
    SCOPED_TRACE(text);
    test::write_text(folder / "x.gltf", text);
    test::expect_error(load_scene(folder / "x.gltf"), {"x.gltf"});
  }
}

TEST(FileErrors, WhatIsNoSceneAtAllIsSaidInWords) {
  const TempFolder folder;
  const auto error = [&](const char* name, const std::string& bytes) {
    test::write_text(folder / name, bytes);
    const auto read = load_scene(folder / name);
    return read ? std::string() : read.error().text();
  };
  for (const char* name : {"x.gltf", "x.glb"})
    EXPECT_NE(error(name, "").find("the file is empty"), std::string::npos) << error(name, "");
  EXPECT_NE(error("x.glb", "hello").find("it does not begin with glTF"), std::string::npos);
  const std::string text = error("x.gltf", "hello");
  EXPECT_NE(text.find("unreadable JSON: parse error at line 1, column 1"), std::string::npos) << text;
  EXPECT_EQ(text.find("exception"), std::string::npos) << text;
}

TEST(FileErrors, OtherVersionsOfGltf) {
  const auto with = [](const nlohmann::json& version) {
    return test::load_edited([&](nlohmann::json& j) { j["asset"]["version"] = version; });
  };
  EXPECT_TRUE(with("2.0"));
  EXPECT_TRUE(with("2.1"));
  test::expect_error(with("1.0"), {"cup.gltf", "asset.version is \"1.0\", and glTF \"2.0\" is what is read"});
  test::expect_error(with("3.0"), {"\"3.0\""});
  test::expect_error(with("2"), {"\"2\""});
  test::expect_error(with("2.x"), {"\"2.x\""});
  test::expect_error(with(2.0), {"asset.version is 2.0"});
  test::expect_error(test::load_edited([](nlohmann::json& j) { j["asset"].erase("version"); }),
                     {"asset.version is missing"});
  test::expect_error(test::load_edited([](nlohmann::json& j) { j["asset"]["minVersion"] = "2.1"; }),
                     {"asset.minVersion is \"2.1\""});
}

TEST(FileErrors, DeepNestingDoesNotOverflowTheStack) {
  const TempFolder folder;
  test::write_text(folder / "deep.gltf", std::string(200000, '[') + std::string(200000, ']'));
  test::expect_error(load_scene(folder / "deep.gltf"), {"deep.gltf"});
  test::write_text(folder / "deep2.gltf",
                   "{\"extras\": " + std::string(100, '[') + std::string(100, ']') + "}");
  test::expect_error(load_scene(folder / "deep2.gltf"), {"nested"});
}

TEST(FileErrors, BrokenGlbHeaders) {
  const TempFolder folder;
  ASSERT_TRUE(test::make_cup().write(folder / "cup.glb"));
  const std::string good = read_bytes(folder / "cup.glb");
  ASSERT_TRUE(load_scene(folder / "cup.glb"));
  for (const std::size_t at : {std::size_t{4}, std::size_t{8}, std::size_t{12}, std::size_t{16}}) {
    for (const unsigned char value : {0x00, 0x7F, 0xFF}) {
      std::string bad = good;
      for (std::size_t i = 0; i < 4; ++i) bad[at + i] = static_cast<char>(value);
      test::write_text(folder / "bad.glb", bad);
      SCOPED_TRACE(std::to_string(at) + " " + std::to_string(value));
      EXPECT_FALSE(load_scene(folder / "bad.glb"));
    }
  }
}

class CutOff : public ::testing::TestWithParam<const char*> {};

TEST_P(CutOff, AtAHundredPlacesNeverCrashes) {
  const TempFolder folder;
  const std::string name = std::string("bucket") + GetParam();
  ASSERT_TRUE(make::make_bucket().write(folder / name));
  const std::string whole = read_bytes(folder / name);
  ASSERT_TRUE(load_scene(folder / name));
  for (std::size_t i = 0; i < 100; ++i) {
    const std::size_t length = whole.size() * i / 100;
    test::write_text(folder / name, whole.substr(0, length));
    const auto result = load_scene(folder / name);
    ASSERT_FALSE(result) << length << " of " << whole.size() << " bytes";
    EXPECT_FALSE(result.error().what.empty());
  }
}

TEST_P(CutOff, WithBytesChangedNeverCrashes) {
  const TempFolder folder;
  const std::string name = std::string("cup") + GetParam();
  ASSERT_TRUE(test::make_cup().write(folder / name));
  const std::string whole = read_bytes(folder / name);
  std::mt19937 bits(11);
  for (int i = 0; i < 400; ++i) {
    std::string bad = whole;
    const std::size_t changes = 1 + bits() % 4;
    for (std::size_t c = 0; c < changes; ++c) bad[bits() % bad.size()] = static_cast<char>(bits() % 256);
    test::write_text(folder / name, bad);
    const auto result = load_scene(folder / name);  // a changed byte of a number may well still load
    if (!result) {
      EXPECT_FALSE(result.error().where.empty());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Containers, CutOff, ::testing::Values(".gltf", ".glb"),
                         [](const auto& param) { return std::string(param.param).substr(1); });

/// Replaces every value in the JSON of a scene, one at a time, by something odd.
void each_place(nlohmann::json& value, const std::function<void(nlohmann::json&)>& visit) {
  if (value.is_object() || value.is_array()) {
    for (auto& item : value) {
      visit(item);
      each_place(item, visit);
    }
  }
}

TEST(FileErrors, OddValuesInEveryPlaceNeverCrash) {
  const TempFolder folder;
  ASSERT_TRUE(test::make_cup().write(folder / "cup.gltf"));
  nlohmann::json file = test::read_json(folder / "cup.gltf");
  const nlohmann::json odd[] = {
      nullptr, -1, 1e300, 4294967296u, "odd", nlohmann::json::array(), nlohmann::json::object(), true};
  // The last samples of long lists tell nothing new.
  std::size_t tried = 0;
  each_place(file, [&](nlohmann::json& place) {
    const nlohmann::json before = place;
    for (const nlohmann::json& value : odd) {
      place = value;
      test::write_text(folder / "odd.gltf", file.dump());
      const auto result = load_scene(folder / "odd.gltf");
      if (!result) {
        EXPECT_FALSE(result.error().text().empty());
      }
      ++tried;
    }
    place = before;
  });
  EXPECT_GT(tried, 1000u);
}

}  // namespace
}  // namespace slosh
