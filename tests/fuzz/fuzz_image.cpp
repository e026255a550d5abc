// A texture's picture: from a file, or from a host that nobody knows.
#include "net/text/clean.h"
#include "scenes/images/decode.h"
#include "tests/fuzz/must.h"
#include "tests/fuzz/seeds.h"
#include "tests/scenes/images_kit.h"

using namespace slosh;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span bytes(data, size);
  const Result<images::Facts> facts = images::look_at(bytes, "image");
  if (facts) {
    test::must(facts.value().width >= 1 && facts.value().height >= 1, "a size");
    test::must(facts.value().width <= images::kLargestSide && facts.value().height <= images::kLargestSide,
               "a size that is taken");
    if (facts.value().pixels() > (std::size_t{1} << 22)) return 0;  // it would only be slow
  }
  const Result<images::Pixels> pixels = images::decode(bytes, "image");
  if (!pixels) {
    test::must(clean_text(pixels.error().text(), 2000) == pixels.error().text(), "an error can be told");
    return 0;
  }
  test::must(static_cast<bool>(facts), "what unpacks has a head");
  test::must(pixels.value().rgba.size() == 4 * facts.value().pixels(), "as many pixels as its head says");
  return 0;
}

std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  const test::Bytes pixels(16 * 8 * 4, 77);
  return {test::png(16, 8, pixels), test::png(16, 8, pixels, PNG_FORMAT_GRAY),
          test::png(8, 8, pixels, PNG_FORMAT_LINEAR_RGB_ALPHA), test::jpeg(16, 8, pixels),
          test::jpeg(16, 8, pixels, true)};
}
