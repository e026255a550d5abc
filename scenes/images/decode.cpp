#include "scenes/images/decode.h"

#include <png.h>

// libjpeg's header needs the FILE of png.h.
#include <jerror.h>
#include <jpeglib.h>

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstring>

namespace slosh::images {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr const char* kMend = "Save the picture again as PNG or JPEG, and export again";
constexpr int kMaxScans = 100;  // of a progressive JPEG: each costs as much as the whole picture
constexpr std::size_t kMaxPixelsAByte = 600;  // of a JPEG: an even grey one has 512, by a bit a block
constexpr std::size_t kMaxChunk = 1 << 20;    // bytes of a PNG's chunk beside its pixels

bool begins_with(Bytes bytes, std::initializer_list<std::uint8_t> magic) {
  return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
}
bool is_png(Bytes bytes) {
  return begins_with(bytes, {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'});
}
bool is_jpeg(Bytes bytes) {
  return begins_with(bytes, {0xff, 0xd8, 0xff});
}

Result<Facts> fits(const Facts& facts, const std::string& name) {
  if (facts.width >= 1 && facts.height >= 1 && facts.width <= kLargestSide && facts.height <= kLargestSide)
    return facts;
  return Error{name,
               "is " + std::to_string(facts.width) + " × " + std::to_string(facts.height) +
                   " pixels, the limit is " + std::to_string(kLargestSide) + " a side",
               "Scale the picture down"};
}

/// The first chunk of every PNG holds its size.
Result<Facts> png_facts(Bytes bytes, const std::string& name) {
  if (bytes.size() < 33 || std::memcmp(bytes.data() + 12, "IHDR", 4) != 0)
    return Error{name, "is a PNG that is cut off in its head", kMend};
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes[at + i];
    return static_cast<int>(std::min(value, 0x7fffffffu));
  };
  return fits({"PNG", number(16), number(20)}, name);
}

// libpng and libjpeg come back from an error by longjmp. What is jumped over has no destructors: everything
// that has one is made by the callers of these functions.

struct PngSource {
  Bytes bytes;
  std::size_t at = 0;
};

void read_png_bytes(png_structp png, png_bytep to, png_size_t size) {
  auto& source = *static_cast<PngSource*>(png_get_io_ptr(png));
  if (size > source.bytes.size() - source.at) png_error(png, "cut off");
  std::memcpy(to, source.bytes.data() + source.at, size);
  source.at += size;
}

void keep_png_problem(png_structp png, png_const_charp problem) {
  std::snprintf(static_cast<char*>(png_get_error_ptr(png)), 200, "%s", problem);
  png_longjmp(png, 1);
}

/// False, and `problem` (200 bytes), where it is damaged.
bool unpack_png(PngSource& source, Pixels& pixels, std::uint8_t** rows, char* problem) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, problem, keep_png_problem,
                                           [](png_structp, png_const_charp) {});
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info || setjmp(png_jmpbuf(png))) {
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  png_set_user_limits(png, kLargestSide, kLargestSide);
  png_set_chunk_malloc_max(png, kMaxChunk);
  png_set_chunk_cache_max(png, 8);
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, 0);
  png_set_read_fn(png, &source, read_png_bytes);
  png_read_info(png, info);
  png_set_scale_16(png);
  png_set_expand(png);  // palettes, few bits, transparent colours
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 255, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  if (png_get_image_width(png, info) != static_cast<png_uint_32>(pixels.width) ||
      png_get_image_height(png, info) != static_cast<png_uint_32>(pixels.height) ||
      png_get_rowbytes(png, info) != static_cast<std::size_t>(4) * static_cast<std::size_t>(pixels.width))
    png_error(png, "its head contradicts itself");
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  png_destroy_read_struct(&png, &info, nullptr);
  return true;
}

struct JpegTrouble {
  jpeg_error_mgr manager;  // first: libjpeg knows only this
  std::jmp_buf back;
  char problem[JMSG_LENGTH_MAX];
};

[[noreturn]] void keep_jpeg_problem(j_common_ptr jpeg) {
  auto* trouble = reinterpret_cast<JpegTrouble*>(jpeg->err);
  (*jpeg->err->format_message)(jpeg, trouble->problem);
  std::longjmp(trouble->back, 1);
}

/// A warning of damage is an error; what cameras write between markers, and level 0 and above, is gossip.
void stop_at_damage(j_common_ptr jpeg, int level) {
  const int code = jpeg->err->msg_code;
  if (level < 0 && code != JWRN_EXTRANEOUS_DATA && code != JWRN_JFIF_MAJOR) keep_jpeg_problem(jpeg);
}

void count_scans(j_common_ptr jpeg) {
  if (!jpeg->is_decompressor) return;
  if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number <= kMaxScans) return;
  auto* trouble = reinterpret_cast<JpegTrouble*>(jpeg->err);
  std::snprintf(trouble->problem, sizeof trouble->problem, "more than %d scans", kMaxScans);
  std::longjmp(trouble->back, 1);
}

/// Without `rgba` the head alone. False, and `problem` (JMSG_LENGTH_MAX bytes), where it is damaged.
bool unpack_jpeg(Bytes bytes, Facts& facts, std::uint8_t* rgba, char* problem) {
  jpeg_decompress_struct jpeg;
  jpeg_progress_mgr progress{};
  JpegTrouble trouble;
  jpeg.err = jpeg_std_error(&trouble.manager);
  trouble.manager.error_exit = keep_jpeg_problem;
  trouble.manager.emit_message = stop_at_damage;
  trouble.problem[0] = '\0';
  if (setjmp(trouble.back)) {
    std::memcpy(problem, trouble.problem, sizeof trouble.problem);
    jpeg_destroy_decompress(&jpeg);
    return false;
  }
  jpeg_create_decompress(&jpeg);
  progress.progress_monitor = count_scans;
  jpeg.progress = &progress;
  jpeg_mem_src(&jpeg, bytes.data(), bytes.size());
  jpeg_read_header(&jpeg, TRUE);
  facts = {"JPEG", static_cast<int>(jpeg.image_width), static_cast<int>(jpeg.image_height)};
  if (rgba) {
    jpeg.out_color_space = JCS_EXT_RGBA;  // alpha 255
    jpeg_start_decompress(&jpeg);
    while (jpeg.output_scanline < jpeg.output_height) {
      JSAMPROW row = rgba + std::size_t{4} * jpeg.output_width * jpeg.output_scanline;
      jpeg_read_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_decompress(&jpeg);
  }
  jpeg_destroy_decompress(&jpeg);
  return true;
}

}  // namespace

Result<Facts> look_at(Bytes bytes, const std::string& name) {
  if (is_png(bytes)) return png_facts(bytes, name);
  if (!is_jpeg(bytes)) return Error{name, "is neither a PNG nor a JPEG", kMend};
  Facts facts;
  char problem[JMSG_LENGTH_MAX];
  if (!unpack_jpeg(bytes, facts, nullptr, problem))
    return Error{name, std::string("is a JPEG that cannot be read: ") + problem, kMend};
  // libjpeg makes room for all of a progressive picture before it reads on.
  if (facts.pixels() / kMaxPixelsAByte > bytes.size()) return Error{name, "is a JPEG that is cut off", kMend};
  return fits(facts, name);
}

Result<Pixels> decode(Bytes bytes, const std::string& name) {
  const Result<Facts> facts = look_at(bytes, name);
  if (!facts) return facts.error();
  Pixels pixels{facts.value().width, facts.value().height, {}};
  const std::size_t row = std::size_t{4} * static_cast<std::size_t>(pixels.width);
  pixels.rgba.resize(row * static_cast<std::size_t>(pixels.height));
  char problem[std::max(JMSG_LENGTH_MAX, 200)] = "";
  bool whole = false;
  if (is_png(bytes)) {
    std::vector<std::uint8_t*> rows(static_cast<std::size_t>(pixels.height));
    for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = pixels.rgba.data() + y * row;
    PngSource source{bytes};
    whole = unpack_png(source, pixels, rows.data(), problem);
  } else {
    Facts again;
    whole = unpack_jpeg(bytes, again, pixels.rgba.data(), problem);
  }
  if (!whole)
    return Error{name, std::string("is a ") + facts.value().format + " that cannot be read: " + problem,
                 kMend};
  return pixels;
}

}  // namespace slosh::images
