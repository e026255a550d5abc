// Memory on the GPU and pinned memory beside it, freed with its owner.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

namespace slosh::cuda {

/// Keeps the first CUDA error of an engine. Every call goes through ok(); after an error nothing more is
/// launched.
class CallCheck {
 public:
  /// True when this call and all before it succeeded.
  bool ok(cudaError_t code, const char* what) {
    if (code != cudaSuccess && failure_.empty()) {
      failure_ = std::string(what) + ": " + cudaGetErrorString(code);
      static_cast<void>(cudaGetLastError());  // or the next world's first call would be blamed for it
    }
    return failure_.empty();
  }
  /// The same for a kernel launch.
  bool launched(const char* what) { return ok(cudaGetLastError(), what); }
  bool failed() const { return !failure_.empty(); }
  const std::string& failure() const { return failure_; }

 private:
  std::string failure_;
};

/// An array on the GPU. Empty until allocated; never managed memory.
template <class T>
class DeviceBuffer {
 public:
  DeviceBuffer() = default;
  ~DeviceBuffer() { cudaFree(data_); }
  DeviceBuffer(const DeviceBuffer&) = delete;
  DeviceBuffer& operator=(const DeviceBuffer&) = delete;

  /// Room for `count` elements, zeroed. Nothing is allocated for 0.
  void allocate(std::size_t count, CallCheck& check) {
    size_ = count;
    if (count == 0 || check.failed()) return;
    if (check.ok(cudaMalloc(&data_, count * sizeof(T)), "cudaMalloc")) {
      check.ok(cudaMemset(data_, 0, count * sizeof(T)), "cudaMemset");
    }
  }
  void upload(std::span<const T> from, CallCheck& check) {
    allocate(from.size(), check);
    if (from.empty() || check.failed()) return;
    check.ok(cudaMemcpy(data_, from.data(), from.size_bytes(), cudaMemcpyHostToDevice), "upload");
  }

  /// Into what is allocated; at most size() elements. Returns when they are there.
  void write(std::span<const T> from, CallCheck& check, cudaStream_t stream) {
    if (from.empty() || check.failed()) return;
    check.ok(cudaMemcpyAsync(data_, from.data(), from.size_bytes(), cudaMemcpyHostToDevice, stream),
             "upload");
    check.ok(cudaStreamSynchronize(stream), "upload");
  }

  /// Likewise, from element `first` on.
  void write_from(std::size_t first, std::span<const T> from, CallCheck& check, cudaStream_t stream) {
    if (from.empty() || check.failed()) return;
    check.ok(cudaMemcpyAsync(data_ + first, from.data(), from.size_bytes(), cudaMemcpyHostToDevice, stream),
             "upload");
    check.ok(cudaStreamSynchronize(stream), "upload");
  }

  T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Host memory that the GPU copies to and from without waiting.
template <class T>
class PinnedBuffer {
 public:
  PinnedBuffer() = default;
  ~PinnedBuffer() { cudaFreeHost(data_); }
  PinnedBuffer(const PinnedBuffer&) = delete;
  PinnedBuffer& operator=(const PinnedBuffer&) = delete;

  void allocate(std::size_t count, CallCheck& check) {
    size_ = count;
    if (count == 0 || check.failed()) return;
    if (!check.ok(cudaMallocHost(&data_, count * sizeof(T)), "cudaMallocHost")) return;
    for (std::size_t i = 0; i < count; ++i) data_[i] = T{};
  }
  T& operator[](std::size_t i) const { return data_[i]; }
  T* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// One of the values that lie from byte `at` on.
template <class T>
T read_at(const PinnedBuffer<unsigned char>& from, std::size_t at, std::size_t index) {
  T value;
  std::memcpy(&value, from.data() + at + index * sizeof value, sizeof value);
  return value;
}

}  // namespace slosh::cuda
