/* Open Sound Control 1.0 as it comes in a datagram: messages, and bundles of them. Every byte is foreign:
 * nothing is handed on of a message that is not whole. */
#ifndef SLOSH_OSC_PACKET_H
#define SLOSH_OSC_PACKET_H

#include <stddef.h>

/* Points into the packet. */
typedef struct osc_message {
  const char* address; /* begins with '/', ends in '\0' */
  const char* types;   /* one letter an argument, ends in '\0' */
  const unsigned char* arguments;
} osc_message;

typedef void (*osc_take)(void* whom, const osc_message* message);

/* Hands each message of a packet to `take`, whatever time its bundle names: a tracker's newest word is what
 * counts, and its clock may be off. NULL, or what is wrong with the packet from where the messages end, a
 * sentence's end: "is cut short". */
const char* osc_walk(const unsigned char* packet, size_t size, osc_take take, void* whom);

/* The argument number `index` as a number (i, h, f or d). 0: it is none. */
int osc_number(const osc_message* message, size_t index, double* value);
/* The same as a text (s or S). NULL: it is none. */
const char* osc_text(const osc_message* message, size_t index);

#endif
