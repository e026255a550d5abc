// Reading accessors with every bound checked: the library underneath checks none.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <string>
#include <vector>

#include "sim/math/result.h"

namespace slosh::gltf {

/// Which whole numbers may stand for numbers.
enum class Integers {
  kNone,
  kNormalized,  ///< of [−1, 1] or [0, 1], where the accessor says that they are
  kAny,         ///< these, and others as they are (KHR_mesh_quantization)
};

/// Reads an accessor's numbers, `components` an element (1 scalar, 2 VEC2, 3 VEC3, 4 VEC4), normalised
/// integers as `integers` has it; what is sparse is filled in. `where` begins the error ("file: mesh 'x':
/// POSITION"). Errors: index out of range, wrong type, buffer view or buffer exceeded, a number that is not
/// finite.
Result<std::vector<double>> read_numbers(const tinygltf::Model& model, int accessor, int components,
                                         Integers integers, const std::string& where);

/// Reads scalar indices (unsigned 8, 16 or 32 bits), each below `limit`.
Result<std::vector<std::uint32_t>> read_indices(const tinygltf::Model& model, int accessor, std::size_t limit,
                                                const std::string& where);

}  // namespace slosh::gltf
