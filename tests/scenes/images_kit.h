// Pictures as bytes, made for tests.
#pragma once

// libjpeg's header needs the FILE of png.h.
// clang-format off
#include <png.h>
#include <jpeglib.h>
// clang-format on
#include <zlib.h>

#include <cstdint>
#include <cstdlib>
#include <vector>

namespace slosh::test {

using Bytes = std::vector<std::uint8_t>;

/// `format`: PNG_FORMAT_RGBA, PNG_FORMAT_GRAY, …; pixels accordingly.
inline Bytes png(int width, int height, const Bytes& pixels, png_uint_32 format = PNG_FORMAT_RGBA) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = format;
  png_alloc_size_t size = 0;
  png_image_write_to_memory(&image, nullptr, &size, 0, pixels.data(), 0, nullptr);
  Bytes bytes(size);
  png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr);
  bytes.resize(size);
  return bytes;
}

/// Of RGB pixels.
inline Bytes jpeg(int width, int height, const Bytes& rgb, bool progressive = false) {
  jpeg_compress_struct writer;
  jpeg_error_mgr manager;
  writer.err = jpeg_std_error(&manager);
  jpeg_create_compress(&writer);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&writer, &memory, &size);
  writer.image_width = static_cast<JDIMENSION>(width);
  writer.image_height = static_cast<JDIMENSION>(height);
  writer.input_components = 3;
  writer.in_color_space = JCS_RGB;
  jpeg_set_defaults(&writer);
  jpeg_set_quality(&writer, 95, TRUE);
  if (progressive) jpeg_simple_progression(&writer);
  jpeg_start_compress(&writer, TRUE);
  while (writer.next_scanline < writer.image_height) {
    auto* row =
        const_cast<std::uint8_t*>(rgb.data()) + std::size_t{3} * writer.image_width * writer.next_scanline;
    jpeg_write_scanlines(&writer, &row, 1);
  }
  jpeg_finish_compress(&writer);
  jpeg_destroy_compress(&writer);
  Bytes bytes(memory, memory + size);
  std::free(memory);
  return bytes;
}

/// Width and height in a PNG's or a JPEG's head, changed without its picture.
inline void claim_size(Bytes& bytes, std::uint32_t width, std::uint32_t height) {
  if (bytes[0] == 0x89) {
    for (int i = 0; i < 4; ++i) {
      bytes[static_cast<std::size_t>(16 + i)] = static_cast<std::uint8_t>(width >> (24 - 8 * i));
      bytes[static_cast<std::size_t>(20 + i)] = static_cast<std::uint8_t>(height >> (24 - 8 * i));
    }
    const auto crc = static_cast<std::uint32_t>(crc32(0, bytes.data() + 12, 17));
    for (int i = 0; i < 4; ++i)
      bytes[static_cast<std::size_t>(29 + i)] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
    return;
  }
  for (std::size_t i = 2; i + 8 < bytes.size();) {  // to the start of the frame
    if (bytes[i + 1] == 0xc0 || bytes[i + 1] == 0xc2) {
      bytes[i + 5] = static_cast<std::uint8_t>(height >> 8);
      bytes[i + 6] = static_cast<std::uint8_t>(height);
      bytes[i + 7] = static_cast<std::uint8_t>(width >> 8);
      bytes[i + 8] = static_cast<std::uint8_t>(width);
      return;
    }
    i += 2u + (static_cast<std::size_t>(bytes[i + 2]) << 8 | bytes[i + 3]);
  }
}

}  // namespace slosh::test
