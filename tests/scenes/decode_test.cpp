// Pictures to pixels: every form that exporters write, and anything at all in their place.
#include "scenes/images/decode.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <string>

#include "net/text/clean.h"
#include "tests/scenes/images_kit.h"

namespace slosh {
namespace {

using test::Bytes;

const Bytes kFour = {255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 0, 10, 20, 30, 255};

/// Its pixels, or nothing and the reason in `why`.
std::optional<images::Pixels> unpack(const Bytes& bytes, std::string* why = nullptr) {
  Result<images::Pixels> result = images::decode(bytes, "image 'x'");
  if (result) {
    EXPECT_EQ(result.value().rgba.size(), std::size_t{4} * static_cast<std::size_t>(result.value().width) *
                                              static_cast<std::size_t>(result.value().height));
    return std::move(result.value());
  }
  EXPECT_TRUE(result.error().where.starts_with("image 'x'"));
  EXPECT_FALSE(result.error().mend.empty());
  if (why) *why = result.error().text();
  return std::nullopt;
}

TEST(Decode, PngsOfEveryForm) {
  const auto rgba = unpack(test::png(2, 2, kFour));
  ASSERT_TRUE(rgba);
  EXPECT_EQ(rgba->width, 2);
  EXPECT_EQ(rgba->rgba, kFour);
  const auto rgb = unpack(test::png(2, 1, {1, 2, 3, 4, 5, 6}, PNG_FORMAT_RGB));
  ASSERT_TRUE(rgb);
  EXPECT_EQ(rgb->rgba, (Bytes{1, 2, 3, 255, 4, 5, 6, 255}));
  const auto grey = unpack(test::png(3, 1, {0, 77, 255}, PNG_FORMAT_GRAY));
  ASSERT_TRUE(grey);
  EXPECT_EQ(grey->rgba, (Bytes{0, 0, 0, 255, 77, 77, 77, 255, 255, 255, 255, 255}));
  const auto grey_alpha = unpack(test::png(1, 1, {77, 33}, PNG_FORMAT_GA));
  ASSERT_TRUE(grey_alpha);
  EXPECT_EQ(grey_alpha->rgba, (Bytes{77, 77, 77, 33}));
}

TEST(Decode, JpegsOfBothKinds) {
  Bytes rgb;
  for (int i = 0; i < 32 * 16; ++i) rgb.insert(rgb.end(), {200, 100, 50});
  for (const bool progressive : {false, true}) {
    const auto pixels = unpack(test::jpeg(32, 16, rgb, progressive));
    ASSERT_TRUE(pixels) << progressive;
    EXPECT_EQ(pixels->width, 32);
    EXPECT_EQ(pixels->height, 16);
    for (std::size_t i = 0; i < pixels->rgba.size(); i += 4) {
      ASSERT_NEAR(pixels->rgba[i], 200, 3);
      ASSERT_NEAR(pixels->rgba[i + 1], 100, 3);
      ASSERT_NEAR(pixels->rgba[i + 2], 50, 3);
      ASSERT_EQ(pixels->rgba[i + 3], 255);
    }
  }
}

Bytes noise(std::size_t size) {
  Bytes bytes;
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < size; ++i)
    bytes.push_back(static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24));
  return bytes;
}

TEST(Decode, WhatIsCutOffOrNoPictureIsSaidSo) {
  std::string why;
  EXPECT_FALSE(unpack({}, &why));
  EXPECT_NE(why.find("neither a PNG nor a JPEG"), std::string::npos) << why;
  EXPECT_FALSE(unpack({'R', 'I', 'F', 'F', 'W', 'E', 'B', 'P'}, &why));
  EXPECT_NE(why.find("neither a PNG nor a JPEG"), std::string::npos) << why;
  for (const Bytes& whole : {test::png(16, 16, noise(16 * 16 * 4)), test::jpeg(16, 16, noise(16 * 16 * 3)),
                             test::jpeg(16, 16, noise(16 * 16 * 3), true)}) {
    ASSERT_TRUE(unpack(whole));
    for (std::size_t size = 0; size < whole.size() - 12; ++size) {  // a PNG's last chunk says nothing
      ASSERT_FALSE(unpack(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)), &why))
          << size;
      ASSERT_TRUE(why.find("cannot be read") != std::string::npos ||
                  why.find("neither") != std::string::npos || why.find("cut off") != std::string::npos)
          << why;
    }
  }
}

TEST(Decode, AnythingAtAllIsAPictureOrASentence) {
  for (const Bytes& whole : {test::png(16, 16, noise(16 * 16 * 4)), test::jpeg(24, 16, noise(24 * 16 * 3)),
                             test::jpeg(24, 16, noise(24 * 16 * 3), true)}) {
    for (std::size_t seed = 1; seed < 600; ++seed) {
      Bytes damaged = whole;
      for (std::size_t k = 0; k < 4; ++k)
        damaged[(seed * 7919 + k * 104729) % damaged.size()] ^= static_cast<std::uint8_t>(seed + 31 * k);
      std::string why;
      unpack(damaged, &why);
      EXPECT_EQ(clean_text(why, 2000), why);
    }
  }
}

TEST(Decode, ABombCostsNoMoreThanItsPixels) {
  std::string why;
  // Larger than is taken: no byte of it is unpacked.
  Bytes huge = test::png(2, 2, kFour);
  test::claim_size(huge, 60000, 60000);
  EXPECT_FALSE(unpack(huge, &why));
  EXPECT_NE(why.find("60000 × 60000"), std::string::npos) << why;
  test::claim_size(huge, 0x80000000u, 5);
  EXPECT_FALSE(unpack(huge));
  test::claim_size(huge, 0, 5);
  EXPECT_FALSE(unpack(huge));
  // A few bytes that claim the most that is taken are refused before room is made for a progressive picture.
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  for (const bool progressive : {false, true}) {
    Bytes claims = test::jpeg(16, 16, noise(16 * 16 * 3), progressive);
    test::claim_size(claims, 8192, 8192);
    EXPECT_FALSE(unpack(claims, &why));
    EXPECT_NE(why.find("cut off"), std::string::npos) << why;
  }
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 64 << 10) << "KiB";
  // Text that unpacks to a thousand times its size, beside the pixels.
  Bytes text = test::png(2, 2, kFour);
  Bytes zeros(8 << 20, 'a'), packed(zeros.size() / 500);
  uLongf size = packed.size();
  ASSERT_EQ(compress(packed.data(), &size, zeros.data(), zeros.size()), Z_OK);
  Bytes chunk = {'z', 'T', 'X', 't', 'k', 0, 0};
  chunk.insert(chunk.end(), packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size));
  const auto crc = static_cast<std::uint32_t>(crc32(0, chunk.data(), static_cast<uInt>(chunk.size())));
  Bytes whole;
  const auto number = [&](std::uint32_t v) {
    for (int i = 3; i >= 0; --i) whole.push_back(static_cast<std::uint8_t>(v >> (8 * i)));
  };
  number(static_cast<std::uint32_t>(chunk.size() - 4));
  whole.insert(whole.end(), chunk.begin(), chunk.end());
  number(crc);
  text.insert(text.begin() + 33, whole.begin(), whole.end());
  const auto shown = unpack(text);
  ASSERT_TRUE(shown) << "the picture is sound";
  EXPECT_EQ(shown->rgba, kFour);
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 64 << 10) << "KiB";
}

}  // namespace
}  // namespace slosh
