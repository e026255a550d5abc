// What ES 3.0 has no words for but can do in another way, rewritten in a shader's text: buffers that are
// read, arrays of textures, the two outputs of one blend.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slosh {

/// A buffer that a shader reads, as a texture of RGBA32F: item i is the texels of numbers i · texels and on,
/// in rows from the first. Any width that is a multiple of `texels` does.
struct EsBuffer {
  std::string sampler;
  int unit = 0;    ///< kEsBufferUnit and on
  int texels = 1;  ///< of an item
  bool operator==(const EsBuffer&) const = default;
};

/// Units of buffers, after all that the shader files have; ES 3.0 has 32 units at least.
inline constexpr int kEsBufferUnit = 24;
/// Among a program's defines: it writes the second of the two outputs of one blend, in place of the first.
inline constexpr const char* kSecondOutput = "SECOND_OUTPUT";

/// `text` with each `layout(std430, binding = N) readonly buffer B { T items[]; };` as a texture, T a vec4 or
/// a struct of them; other buffers stay, for the caller to refuse.
std::string with_buffers_as_textures(std::string text, std::vector<EsBuffer>& buffers);

/// The number that `word` is, or that `defines` has for it ("MIXED 2"); 0: neither.
int size_of_array(std::string_view word, std::span<const std::string> defines);

/// `text` with `texelFetch(A[i], …)` of an array of textures as a function that knows each by its number. The
/// array's size is as size_of_array has it; of one without a size nothing is changed.
std::string with_arrays_by_number(std::string text, std::span<const std::string> defines);

/// `text` with one of the two outputs `layout(location = L, index = I) out`: the other becomes a plain
/// variable.
std::string with_one_output(std::string text, bool second);

}  // namespace slosh
