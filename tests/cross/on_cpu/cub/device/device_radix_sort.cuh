// CUB's header of that name, as far as sim/cuda needs it: a stable sort of pairs.
#pragma once

#include <numeric>
#include <vector>

#include "device.h"

namespace cub {

struct DeviceRadixSort {
  template <class Key, class Value>
  static cudaError_t SortPairs(void* room, std::size_t& bytes, const Key* keys, Key* sorted_keys,
                               const Value* values, Value* sorted_values, std::uint32_t count, int, int,
                               cudaStream_t) {
    if (!room) {
      bytes = 16;
      return cudaSuccess;
    }
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return keys[a] < keys[b]; });
    std::vector<Key> k;
    std::vector<Value> v;
    for (const std::uint32_t i : order) {
      k.push_back(keys[i]);
      v.push_back(values[i]);
    }
    std::copy(k.begin(), k.end(), sorted_keys);
    std::copy(v.begin(), v.end(), sorted_values);
    return cudaSuccess;
  }
};

}  // namespace cub
