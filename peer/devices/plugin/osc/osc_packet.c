#include "peer/devices/plugin/osc/osc_packet.h"

#include <stdint.h>
#include <string.h>

#define DEEPEST 4 /* bundles in bundles */

static uint64_t big_endian(const unsigned char* at, size_t bytes) {
  uint64_t value = 0;
  for (size_t i = 0; i < bytes; ++i) value = value << 8 | at[i];
  return value;
}

/* Bytes of a text with its '\0' and what fills it to a multiple of four; 0: it does not end in `size`. */
static size_t text_bytes(const unsigned char* at, size_t size) {
  const unsigned char* const end = memchr(at, '\0', size);
  if (end == NULL) return 0;
  const size_t bytes = ((size_t)(end - at) / 4 + 1) * 4;
  return bytes <= size ? bytes : 0;
}

/* Bytes of an argument; SIZE_MAX: it is not whole in `size`, or of no type that is known. */
static size_t argument_bytes(char type, const unsigned char* at, size_t size) {
  size_t bytes = SIZE_MAX;
  switch (type) {
    case 'T':
    case 'F':
    case 'N':
    case 'I':
    case '[':
    case ']':
      return 0;
    case 'i':
    case 'f':
    case 'c':
    case 'r':
    case 'm':
      bytes = 4;
      break;
    case 'h':
    case 'd':
    case 't':
      bytes = 8;
      break;
    case 's':
    case 'S':
      bytes = text_bytes(at, size);
      if (bytes == 0) return SIZE_MAX;
      break;
    case 'b':
      if (size < 4) return SIZE_MAX;
      bytes = 4 + ((size_t)big_endian(at, 4) + 3) / 4 * 4;
      break;
    default:
      return SIZE_MAX;
  }
  return bytes <= size ? bytes : SIZE_MAX;
}

static const char* walk_message(const unsigned char* packet, size_t size, osc_take take, void* whom) {
  osc_message message;
  const size_t address = text_bytes(packet, size);
  if (address == 0) return "is cut short in an address";
  message.address = (const char*)packet;
  if (address == size) return "has a message without types";
  if (packet[address] != ',') return "has a message without types";
  const size_t types = text_bytes(packet + address, size - address);
  if (types == 0) return "is cut short in a message's types";
  message.types = (const char*)packet + address + 1;
  size_t at = address + types;
  message.arguments = packet + at;
  for (const char* type = message.types; *type != '\0'; ++type) {
    const size_t bytes = argument_bytes(*type, packet + at, size - at);
    if (bytes == SIZE_MAX) return "is cut short in a message's arguments, or has one of an unknown type";
    at += bytes;
  }
  take(whom, &message);
  return NULL;
}

static const char* walk(const unsigned char* packet, size_t size, int depth, osc_take take, void* whom) {
  if (size >= 4 && packet[0] == '/') return walk_message(packet, size, take, whom);
  if (size < 16 || memcmp(packet, "#bundle", 8) != 0) return "is no OSC";
  if (depth == DEEPEST) return "has too many bundles in bundles";
  for (size_t at = 16; at < size;) {
    if (size - at < 4) return "is cut short in a bundle";
    const size_t bytes = (size_t)big_endian(packet + at, 4);
    at += 4;
    if (bytes > size - at) return "is cut short in a bundle";
    const char* const wrong = walk(packet + at, bytes, depth + 1, take, whom);
    if (wrong != NULL) return wrong;
    at += bytes;
  }
  return NULL;
}

const char* osc_walk(const unsigned char* packet, size_t size, osc_take take, void* whom) {
  return walk(packet, size, 0, take, whom);
}

/* Where an argument is; NULL: there is none of that number. Only of messages that walk_message() found whole.
 */
static const unsigned char* argument(const osc_message* message, size_t index) {
  const unsigned char* at = message->arguments;
  if (index >= strlen(message->types)) return NULL;
  for (size_t i = 0; i < index; ++i) at += argument_bytes(message->types[i], at, SIZE_MAX / 2);
  return at;
}

int osc_number(const osc_message* message, size_t index, double* value) {
  const unsigned char* const at = argument(message, index);
  if (at == NULL) return 0;
  switch (message->types[index]) {
    case 'i':
      *value = (double)(int32_t)big_endian(at, 4);
      return 1;
    case 'h':
      *value = (double)(int64_t)big_endian(at, 8);
      return 1;
    case 'f': {
      const uint32_t bits = (uint32_t)big_endian(at, 4);
      float number = 0.0f;
      memcpy(&number, &bits, sizeof number);
      *value = (double)number;
      return 1;
    }
    case 'd': {
      const uint64_t bits = big_endian(at, 8);
      memcpy(value, &bits, sizeof *value);
      return 1;
    }
    default:
      return 0;
  }
}

const char* osc_text(const osc_message* message, size_t index) {
  const unsigned char* const at = argument(message, index);
  return at != NULL && (message->types[index] == 's' || message->types[index] == 'S') ? (const char*)at
                                                                                      : NULL;
}
