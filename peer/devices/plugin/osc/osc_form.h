/* Which messages tell of a tracker, and how its numbers are meant. */
#ifndef SLOSH_OSC_FORM_H
#define SLOSH_OSC_FORM_H

#include "peer/devices/plugin/osc/osc_packet.h"

enum osc_what { OSC_POSE, OSC_POSITION, OSC_ROTATION };

#define OSC_ADDRESSES 4

typedef struct osc_form {
  char host[64]; /* IPv4 */
  int port;
  struct {
    char address[128];
    enum osc_what what;
  } entries[OSC_ADDRESSES];
  int count;
  char serial[64]; /* the first argument, where several trackers have one address; empty: any */
  int left_handed; /* Unity's frame: x to the right, y up, z away from the user. Else ours: z towards them */
  double unit;     /* m */
} osc_form;

/* As slosh_device_reading has it: m, wxyz, x to the right, y up, z towards the user. */
typedef struct osc_pose {
  double position[3];
  double orientation[4];
} osc_pose;

/* OPTIONS as peer/devices/PROTOCOLS.md has them. 0, or a sentence in `error`. */
int osc_form_parse(const char* options, osc_form* form, char* error, size_t size);

/* 0: the message is not of this tracker. 1: what it tells is in `pose`. 2: the same, and it tells where the
 * tracker is. -1: it is, and cannot be used: a sentence in `error`. */
int osc_form_read(const osc_form* form, const osc_message* message, osc_pose* pose, char* error, size_t size);

#endif
