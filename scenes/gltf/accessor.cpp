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

/// So many elements from a byte of a buffer view on.
struct Data {
  int view = -1;
  std::size_t offset = 0;
  std::size_t count = 0;
  int component_type = 0;
  std::size_t element = 0;  ///< bytes
};

Result<Span> find_data(const tinygltf::Model& model, const Data& data, const std::string& who) {
  const char* const again = "Export the file again";
  if (data.view < 0 || static_cast<std::size_t>(data.view) >= model.bufferViews.size()) {
    return Error{
        who, "points at bufferView " + std::to_string(data.view) + " of " + number(model.bufferViews.size()),
        again};
  }
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(data.view)];
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
  const std::size_t element = data.element;
  if (element == 0) return Error{who, "has an unknown component type", again};
  const std::size_t stride = view.byteStride == 0 ? element : view.byteStride;
  if (stride < element || stride > 252 + element)
    return Error{who, "has the byteStride " + number(stride), again};
  if (data.count == 0) return Error{who, "is empty", again};
  // In this order nothing can overflow: element <= view, then how many strides fit.
  const bool starts_inside = data.offset <= view.byteLength && view.byteLength - data.offset >= element;
  if (!starts_inside || data.count - 1 > (view.byteLength - data.offset - element) / stride) {
    return Error{who,
                 "has " + number(data.count) + " elements of " + number(element) + " bytes from byte " +
                     number(data.offset) + ", its bufferView has " + number(view.byteLength) + " bytes",
                 again};
  }
  return Span{model.buffers[view.buffer].data.data() + view.byteOffset + data.offset, stride, data.count,
              data.component_type};
}

Result<Span> find_span(const tinygltf::Model& model, int index, int components, const std::string& where) {
  const char* const again = "Export the file again";
  if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size()) {
    return Error{where, "accessor " + std::to_string(index) + " does not exist", again};
  }
  const tinygltf::Accessor& accessor = model.accessors[index];
  const std::string who = where + ": accessor " + std::to_string(index);
  if (accessor.type != gltf_type(components)) {
    return Error{who,
                 "has " + std::to_string(tinygltf::GetNumComponentsInType(accessor.type)) +
                     " numbers an element, " + std::to_string(components) + " are needed",
                 again};
  }
  const int size = component_size(accessor.componentType);
  if (size == 0)
    return Error{who, "has the unknown component type " + std::to_string(accessor.componentType), again};
  return find_data(model,
                   {accessor.bufferView, accessor.byteOffset, accessor.count, accessor.componentType,
                    static_cast<std::size_t>(size) * static_cast<std::size_t>(components)},
                   who);
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

double load_integer(const unsigned char* from, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return load<std::int8_t>(from);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(from);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return load<std::int16_t>(from);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(from);
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

std::optional<std::uint32_t> load_index(const unsigned char* from, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(from);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(from);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load<std::uint32_t>(from);
    default:
      return std::nullopt;
  }
}

/// A sparse accessor need not have data to begin with: it is zeros, and these are bounded here, since no
/// buffer does.
constexpr std::size_t kMaxZeros = 6'000'000;

bool is_sparse_alone(const tinygltf::Model& model, int index) {
  if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size()) return false;
  const tinygltf::Accessor& accessor = model.accessors[index];
  return accessor.sparse.isSparse && accessor.bufferView < 0 && accessor.count > 0 &&
         accessor.count <= kMaxZeros && component_size(accessor.componentType) > 0;
}

Span zeros(const tinygltf::Model& model, int index) {
  return {nullptr, 0, model.accessors[index].count, model.accessors[index].componentType};
}

/// What a sparse accessor puts in place of some of its elements.
struct Replaced {
  std::vector<std::size_t> at;  ///< rising is not asked for
  Span values;
};

Result<Replaced> find_replaced(const tinygltf::Model& model, int index, int components,
                               const std::string& where) {
  const tinygltf::Accessor& accessor = model.accessors[index];
  const auto& sparse = accessor.sparse;
  const std::string who = where + ": accessor " + std::to_string(index);
  const char* const again = "Export the file again";
  if (sparse.count <= 0 || static_cast<std::size_t>(sparse.count) > accessor.count ||
      sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0 || accessor.type != gltf_type(components))
    return Error{who, "its sparse part fits nothing", again};
  const auto count = static_cast<std::size_t>(sparse.count);
  const auto size = static_cast<std::size_t>(component_size(accessor.componentType));
  const Result<Span> where_to = find_data(
      model,
      {sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), count,
       sparse.indices.componentType, static_cast<std::size_t>(component_size(sparse.indices.componentType))},
      who + ": sparse indices");
  if (!where_to) return where_to.error();
  const Result<Span> values =
      find_data(model,
                {sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), count,
                 accessor.componentType, size * components},
                who + ": sparse values");
  if (!values) return values.error();
  Replaced out{{}, values.value()};
  for (std::size_t i = 0; i < count; ++i) {
    const auto at =
        load_index(where_to.value().first + i * where_to.value().stride, sparse.indices.componentType);
    if (!at || *at >= accessor.count)
      return Error{who, "its sparse part names an element that is not there", again};
    out.at.push_back(*at);
  }
  return out;
}

}  // namespace

Result<std::vector<double>> read_numbers(const tinygltf::Model& model, int accessor, int components,
                                         Integers integers, const std::string& where) {
  const bool sparse_alone = is_sparse_alone(model, accessor);
  const Result<Span> found =
      sparse_alone ? Result<Span>(zeros(model, accessor)) : find_span(model, accessor, components, where);
  if (!found) return found.error();
  const Span& span = found.value();
  const bool is_float = span.component_type == TINYGLTF_COMPONENT_TYPE_FLOAT;
  const bool normalized = model.accessors[accessor].normalized;
  if (!is_float && integers != Integers::kAny && !(integers == Integers::kNormalized && normalized)) {
    return Error{where + ": accessor " + std::to_string(accessor), "does not hold 32-bit floats",
                 "Export without quantisation"};
  }
  const int size = component_size(span.component_type);
  std::vector<double> out;
  const auto read = [&](const Span& from, std::size_t i, int c) {
    const unsigned char* at = from.first + i * from.stride + static_cast<std::size_t>(c) * size;
    return is_float     ? load<float>(at)
           : normalized ? load_normalized(at, from.component_type)
                        : load_integer(at, from.component_type);
  };
  if (sparse_alone) {
    out.assign(span.count * components, 0.0);
  } else {
    out.reserve(span.count * components);
    for (std::size_t i = 0; i < span.count; ++i)
      for (int c = 0; c < components; ++c) out.push_back(read(span, i, c));
  }
  if (model.accessors[accessor].sparse.isSparse) {
    const Result<Replaced> replaced = find_replaced(model, accessor, components, where);
    if (!replaced) return replaced.error();
    for (std::size_t i = 0; i < replaced.value().at.size(); ++i) {
      for (int c = 0; c < components; ++c)
        out[replaced.value().at[i] * components + c] = read(replaced.value().values, i, c);
    }
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (std::isfinite(out[i])) continue;
    return Error{where, "element " + number(i / components) + " is not a finite number",
                 "Apply or remove the modifier that made it, then export again"};
  }
  return out;
}

Result<std::vector<std::uint32_t>> read_indices(const tinygltf::Model& model, int accessor, std::size_t limit,
                                                const std::string& where) {
  const Result<Span> found = find_span(model, accessor, 1, where);
  if (!found) return found.error();
  if (model.accessors[accessor].sparse.isSparse)
    return Error{where + ": accessor " + std::to_string(accessor), "is sparse, which indices are not read as",
                 "Export the file again"};
  const Span& span = found.value();
  std::vector<std::uint32_t> out;
  out.reserve(span.count);
  for (std::size_t i = 0; i < span.count; ++i) {
    const std::optional<std::uint32_t> value = load_index(span.first + i * span.stride, span.component_type);
    if (!value) {
      return Error{where + ": accessor " + std::to_string(accessor), "does not hold unsigned integers",
                   "Export the file again"};
    }
    if (*value >= limit) {
      return Error{where, "index " + number(i) + " names vertex " + number(*value) + " of " + number(limit),
                   "Export the file again"};
    }
    out.push_back(*value);
  }
  return out;
}

}  // namespace slosh::gltf
