#include "scenes/gltf/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

namespace slosh::gltf {
namespace {

/// Where an accessor's elements lie, known to be inside the buffer.
struct Span {
  const unsigned char* first = nullptr;
  std::size_t stride = 0;
  std::size_t count = 0;
  int component_type = 0;
};

int component_size(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

int gltf_type(int components) {
  switch (components) {
    case 1:
      return TINYGLTF_TYPE_SCALAR;
    case 2:
      return TINYGLTF_TYPE_VEC2;
    case 3:
      return TINYGLTF_TYPE_VEC3;
    case 4:
      return TINYGLTF_TYPE_VEC4;
    default:
      return -1;
  }
}

std::string number(std::size_t value) {
  return std::to_string(value);
}

Result<Span> find_span(const tinygltf::Model& model, int index, int components, const std::string& where) {
  const char* const again = "Export the file again";
  if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size()) {
    return Error{where, "accessor " + std::to_string(index) + " does not exist", again};
  }
  const tinygltf::Accessor& accessor = model.accessors[index];
  const std::string who = where + ": accessor " + std::to_string(index);
  if (accessor.sparse.isSparse) return Error{who, "is sparse, which is not read", again};
  if (accessor.type != gltf_type(components)) {
    return Error{who,
                 "has " + std::to_string(tinygltf::GetNumComponentsInType(accessor.type)) +
                     " numbers an element, " + std::to_string(components) + " are needed",
                 again};
  }
  const int size = component_size(accessor.componentType);
  if (size == 0)
    return Error{who, "has the unknown component type " + std::to_string(accessor.componentType), again};
  if (accessor.bufferView < 0 || static_cast<std::size_t>(accessor.bufferView) >= model.bufferViews.size()) {
    return Error{who,
                 "points at bufferView " + std::to_string(accessor.bufferView) + " of " +
                     number(model.bufferViews.size()),
                 again};
  }
  const tinygltf::BufferView& view = model.bufferViews[accessor.bufferView];
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size()) {
    return Error{who,
                 "its bufferView points at buffer " + std::to_string(view.buffer) + " of " +
                     number(model.buffers.size()),
                 again};
  }
  const std::size_t bytes = model.buffers[view.buffer].data.size();
  if (view.byteOffset > bytes || view.byteLength > bytes - view.byteOffset) {
    return Error{who,
                 "its bufferView ends at byte " + number(view.byteOffset) + " + " + number(view.byteLength) +
                     ", its buffer has " + number(bytes),
                 again};
  }
  const std::size_t element = static_cast<std::size_t>(size) * components;
  const std::size_t stride = view.byteStride == 0 ? element : view.byteStride;
  if (stride < element || stride > 252 + element)
    return Error{who, "has the byteStride " + number(stride), again};
  if (accessor.count == 0) return Error{who, "is empty", again};
  // In this order nothing can overflow: element <= view, then how many strides fit.
  const bool starts_inside =
      accessor.byteOffset <= view.byteLength && view.byteLength - accessor.byteOffset >= element;
  if (!starts_inside || accessor.count - 1 > (view.byteLength - accessor.byteOffset - element) / stride) {
    return Error{who,
                 "has " + number(accessor.count) + " elements of " + number(element) + " bytes from byte " +
                     number(accessor.byteOffset) + ", its bufferView has " + number(view.byteLength) +
                     " bytes",
                 again};
  }
  return Span{model.buffers[view.buffer].data.data() + view.byteOffset + accessor.byteOffset, stride,
              accessor.count, accessor.componentType};
}

template <class T>
T load(const unsigned char* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));  // files owe no alignment
  return value;
}

/// A normalised integer as glTF 2.0, 3.11 defines it.
double load_normalized(const unsigned char* from, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return std::max(load<std::int8_t>(from) / 127.0, -1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(from) / 255.0;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return std::max(load<std::int16_t>(from) / 32767.0, -1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(from) / 65535.0;
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

Result<std::vector<double>> read_numbers(const tinygltf::Model& model, int accessor, int components,
                                         bool allow_normalized, const std::string& where) {
  const Result<Span> found = find_span(model, accessor, components, where);
  if (!found) return found.error();
  const Span& span = found.value();
  const bool is_float = span.component_type == TINYGLTF_COMPONENT_TYPE_FLOAT;
  if (!is_float && !(allow_normalized && model.accessors[accessor].normalized)) {
    return Error{where + ": accessor " + std::to_string(accessor), "does not hold 32-bit floats",
                 "Export without quantisation"};
  }
  const int size = component_size(span.component_type);
  std::vector<double> out;
  out.reserve(span.count * components);
  for (std::size_t i = 0; i < span.count; ++i) {
    for (int c = 0; c < components; ++c) {
      const unsigned char* from = span.first + i * span.stride + static_cast<std::size_t>(c) * size;
      const double value = is_float ? load<float>(from) : load_normalized(from, span.component_type);
      if (!std::isfinite(value)) {
        return Error{where, "element " + number(i) + " is not a finite number",
                     "Apply or remove the modifier that made it, then export again"};
      }
      out.push_back(value);
    }
  }
  return out;
}

Result<std::vector<std::uint32_t>> read_indices(const tinygltf::Model& model, int accessor, std::size_t limit,
                                                const std::string& where) {
  const Result<Span> found = find_span(model, accessor, 1, where);
  if (!found) return found.error();
  const Span& span = found.value();
  std::vector<std::uint32_t> out;
  out.reserve(span.count);
  for (std::size_t i = 0; i < span.count; ++i) {
    const unsigned char* from = span.first + i * span.stride;
    std::uint32_t value = 0;
    switch (span.component_type) {
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        value = load<std::uint8_t>(from);
        break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        value = load<std::uint16_t>(from);
        break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        value = load<std::uint32_t>(from);
        break;
      default:
        return Error{where + ": accessor " + std::to_string(accessor), "does not hold unsigned integers",
                     "Export the file again"};
    }
    if (value >= limit) {
      return Error{where, "index " + number(i) + " names vertex " + number(value) + " of " + number(limit),
                   "Export the file again"};
    }
    out.push_back(value);
  }
  return out;
}

}  // namespace slosh::gltf
