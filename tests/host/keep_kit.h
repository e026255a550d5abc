// What the tests of checkpoints and recordings share.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "host/keep/checkpoint.h"
#include "host/keep/chunk.h"
#include "host/keep/recording.h"
#include "tests/host/world_kit.h"

namespace slosh::keep {

using std::filesystem::path;
using testing::AtTick;
using testing::fresh_folder;
using testing::Rig;
using testing::small_world;

inline HostOptions until(double time) {
  HostOptions options;
  options.until = time;
  return options;
}

inline Bytes read_all(const path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The bytes as a file that was never on a disk.
class MemoryFile {
 public:
  explicit MemoryFile(ByteView bytes) : bytes_(bytes.begin(), bytes.end()) {
    // fmemopen takes no file without bytes.
    file_ = bytes_.empty() ? std::tmpfile() : fmemopen(bytes_.data(), bytes_.size(), "rb");
  }
  ~MemoryFile() { std::fclose(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::FILE* get() const { return file_; }

 private:
  Bytes bytes_;
  std::FILE* file_;
};

/// All whole ones of a file behind its first `head` bytes.
inline std::vector<Chunk> chunks_of(const path& file, long head) {
  const Bytes bytes = read_all(file);
  const MemoryFile memory(bytes);
  std::fseek(memory.get(), head, SEEK_SET);
  ChunkReader reader(memory.get());
  std::vector<Chunk> all;
  Chunk chunk;
  while (reader.next(chunk) == ChunkOutcome::kChunk) all.push_back(chunk);
  return all;
}

}  // namespace slosh::keep
