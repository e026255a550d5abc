#include "net/quic/connection_memory.h"

#include <cstdint>
#include <cstdlib>

namespace slosh::quic {

ConnectionMemory::ConnectionMemory() : functions_{}, all_{&all_, &all_} {
  functions_.user_data = this;
  functions_.malloc = [](std::size_t size, void* self) {
    return static_cast<ConnectionMemory*>(self)->take(size, false);
  };
  functions_.calloc = [](std::size_t count, std::size_t size, void* self) -> void* {
    if (size != 0 && count > SIZE_MAX / size) return nullptr;
    return static_cast<ConnectionMemory*>(self)->take(count * size, true);
  };
  functions_.realloc = [](void* memory, std::size_t size, void* self) {
    return static_cast<ConnectionMemory*>(self)->resize(memory, size);
  };
  functions_.free = [](void* memory, void* self) { static_cast<ConnectionMemory*>(self)->give_back(memory); };
}

ConnectionMemory::~ConnectionMemory() {
  while (all_.after != &all_) give_back(all_.after + 1);
}

void* ConnectionMemory::take(std::size_t size, bool cleared) {
  if (size > SIZE_MAX - sizeof(Header)) return nullptr;
  const std::size_t whole = sizeof(Header) + size;
  Header* header = static_cast<Header*>(cleared ? std::calloc(1, whole) : std::malloc(whole));
  if (!header) return nullptr;
  link(header);
  return header + 1;
}

void* ConnectionMemory::resize(void* memory, std::size_t size) {
  if (!memory) return take(size, false);
  if (size > SIZE_MAX - sizeof(Header)) return nullptr;
  Header* old = static_cast<Header*>(memory) - 1;
  unlink(old);
  Header* header = static_cast<Header*>(std::realloc(old, sizeof(Header) + size));
  link(header ? header : old);  // without room the old block stays as it was
  return header ? header + 1 : nullptr;
}

void ConnectionMemory::give_back(void* memory) {
  if (!memory) return;
  Header* header = static_cast<Header*>(memory) - 1;
  unlink(header);
  std::free(header);
}

void ConnectionMemory::link(Header* header) {
  header->before = &all_;
  header->after = all_.after;
  all_.after->before = header;
  all_.after = header;
  ++blocks_;
}

void ConnectionMemory::unlink(Header* header) {
  header->before->after = header->after;
  header->after->before = header->before;
  --blocks_;
}

}  // namespace slosh::quic
