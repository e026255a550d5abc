#include "peer/devices/plugin/osc/osc_form.h"

#include <arpa/inet.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FARTHEST 1000.0 /* m */

static int add(osc_form* form, enum osc_what what, const char* before, const char* name, const char* after) {
  if (form->count == OSC_ADDRESSES) return 0;
  const int written = snprintf(form->entries[form->count].address, sizeof form->entries[0].address, "%s%s%s",
                               before, name, after);
  form->entries[form->count++].what = what;
  return written > 1 && written < (int)sizeof form->entries[0].address &&
         form->entries[form->count - 1].address[0] == '/';
}

/* [HOST:]PORT */
static int parse_place(const char* text, osc_form* form) {
  const char* const colon = strrchr(text, ':');
  if (colon != NULL) {
    struct in_addr address;
    const size_t length = (size_t)(colon - text);
    if (length >= sizeof form->host) return 0;
    memcpy(form->host, text, length);
    form->host[length] = '\0';
    if (inet_pton(AF_INET, form->host, &address) != 1) return 0;
  }
  char* end = NULL;
  const long port = strtol(colon != NULL ? colon + 1 : text, &end, 10);
  form->port = (int)port;
  return *end == '\0' && port >= 1 && port <= 65535;
}

/* 1: taken. 0: no such key. -1: not with that value. */
static int parse_key(const char* key, const char* value, osc_form* form) {
  if (strcmp(key, "vrchat") == 0) {
    form->left_handed = 1;
    return add(form, OSC_POSITION, "/tracking/trackers/", value, "/position") &&
                   add(form, OSC_ROTATION, "/tracking/trackers/", value, "/rotation")
               ? 1
               : -1;
  }
  if (strcmp(key, "vmc") == 0) {
    form->left_handed = 1;
    snprintf(form->serial, sizeof form->serial, "%s", value);
    return *value != '\0' && strlen(value) < sizeof form->serial &&
                   add(form, OSC_POSE, "/VMC/Ext/Tra/Pos", "", "") &&
                   add(form, OSC_POSE, "/VMC/Ext/Con/Pos", "", "") &&
                   add(form, OSC_POSE, "/VMC/Ext/Hmd/Pos", "", "")
               ? 1
               : -1;
  }
  if (strcmp(key, "zigsim") == 0)
    return add(form, OSC_POSITION, "/", value, "/arkitposition") &&
                   add(form, OSC_ROTATION, "/", value, "/arkitrotation")
               ? 1
               : -1;
  if (strcmp(key, "pose") == 0) return add(form, OSC_POSE, value, "", "") ? 1 : -1;
  if (strcmp(key, "position") == 0) return add(form, OSC_POSITION, value, "", "") ? 1 : -1;
  if (strcmp(key, "rotation") == 0) return add(form, OSC_ROTATION, value, "", "") ? 1 : -1;
  if (strcmp(key, "serial") == 0) {
    snprintf(form->serial, sizeof form->serial, "%s", value);
    return *value != '\0' && strlen(value) < sizeof form->serial ? 1 : -1;
  }
  if (strcmp(key, "frame") == 0) {
    form->left_handed = strcmp(value, "unity") == 0;
    return form->left_handed || strcmp(value, "right") == 0 ? 1 : -1;
  }
  if (strcmp(key, "unit") == 0) {
    form->unit = strcmp(value, "m") == 0    ? 1.0
                 : strcmp(value, "cm") == 0 ? 0.01
                 : strcmp(value, "mm") == 0 ? 0.001
                                            : 0.0;
    return form->unit > 0.0 ? 1 : -1;
  }
  return 0;
}

int osc_form_parse(const char* options, osc_form* form, char* error, size_t size) {
  char text[1024];
  memset(form, 0, sizeof *form);
  snprintf(form->host, sizeof form->host, "127.0.0.1");
  form->port = 9000;
  form->unit = 1.0;
  if (strlen(options) >= sizeof text) {
    snprintf(error, size, "its options are longer than %zu bytes", sizeof text - 1);
    return -1;
  }
  strcpy(text, options);
  char* rest = text;
  for (int number = 0; rest != NULL && *text != '\0'; ++number) {
    char* const word = rest;
    rest = strchr(word, ',');
    if (rest != NULL) *rest++ = '\0';
    char* const value = strchr(word, '=');
    if (value == NULL && number == 0) {
      if (parse_place(word, form)) continue;
      snprintf(
          error, size,
          "'%s' is no port from 1 to 65535, nor an IPv4 address with one (0.0.0.0:9000: from everywhere)",
          word);
      return -1;
    }
    if (value != NULL) *value = '\0';
    const int taken = value == NULL ? 0 : parse_key(word, value + 1, form);
    if (taken == 1) continue;
    if (taken == 0)
      snprintf(error, size,
               "'%s' is none of vrchat=, vmc=, zigsim=, pose=, position=, rotation=, serial=, frame=, unit=",
               word);
    else
      snprintf(error, size,
               "'%s' cannot be '%s' (addresses begin with '/', four at most; frame: unity or right; unit: m, "
               "cm or mm)",
               word, value + 1);
    return -1;
  }
  if (form->count == 0) add(form, OSC_POSE, "/slosh/hand/pose", "", "");
  for (int i = 0; i < form->count; ++i)
    if (form->entries[i].what != OSC_ROTATION) return 0;
  snprintf(error, size, "a rotation alone is no place: give position= or pose= too");
  return -1;
}

static void multiply(const double a[4], const double b[4], double out[4]) {
  const double q[4] = {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
                       a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
                       a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
                       a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
  memcpy(out, q, sizeof q);
}

/* Degrees about x, y and z, of which z turns first and y last, as Unity has them. */
static void from_angles(const double degrees[3], double q[4]) {
  double turns[3][4] = {{0.0}};
  for (int i = 0; i < 3; ++i) {
    const double half = degrees[i] * 3.14159265358979323846 / 360.0;
    turns[i][0] = cos(half);
    turns[i][1 + i] = sin(half);
  }
  multiply(turns[0], turns[2], q);
  multiply(turns[1], q, q);
}

static int is_of(const osc_form* form, const osc_message* message) {
  if (form->serial[0] == '\0') return 1;
  const char* const text = osc_text(message, 0);
  if (text != NULL) return strcmp(text, form->serial) == 0;
  double number = 0.0;
  char written[32];
  if (!osc_number(message, 0, &number)) return 0;
  snprintf(written, sizeof written, "%.17g", number);
  return strcmp(written, form->serial) == 0;
}

/* What the last arguments of a message say: `numbers` of a place, and `turning` of a rotation. */
static int read_pose(const osc_form* form, const osc_message* message, size_t place, size_t turning,
                     osc_pose* pose, char* error, size_t size) {
  const size_t all = strlen(message->types), wanted = place + turning;
  double v[7];
  for (size_t i = 0; i < wanted; ++i) {
    if (all < wanted || !osc_number(message, all - wanted + i, &v[i])) {
      snprintf(error, size,
               "%.100s came with arguments of the types '%.20s', and its last %zu should be numbers",
               message->address, message->types, wanted);
      return -1;
    }
    if (!isfinite(v[i])) {
      snprintf(error, size, "%.100s came with a number that is not finite", message->address);
      return -1;
    }
  }
  for (size_t i = 0; i < place; ++i)
    if (fabs(v[i] * form->unit) > FARTHEST) {
      snprintf(error, size, "%.100s came with a place %g m away: is its unit another?", message->address,
               v[i] * form->unit);
      return -1;
    }
  double q[4] = {1.0, 0.0, 0.0, 0.0};
  if (turning == 3) from_angles(v + place, q);
  if (turning == 4) {
    const double* const xyzw = v + place;
    const double length = sqrt(xyzw[0] * xyzw[0] + xyzw[1] * xyzw[1] + xyzw[2] * xyzw[2] + xyzw[3] * xyzw[3]);
    if (!(fabs(length - 1.0) <= 0.1)) {
      snprintf(error, size, "%.100s came with a rotation (x y z w) of length %.3g in place of 1",
               message->address, length);
      return -1;
    }
    q[0] = xyzw[3] / length;
    for (int i = 0; i < 3; ++i) q[1 + i] = xyzw[i] / length;
  }
  /* Mirrored in z: an axis is turned about the other way, unless it is z itself. */
  const double side = form->left_handed ? -1.0 : 1.0;
  if (place > 0) {
    for (int i = 0; i < 3; ++i) pose->position[i] = v[i] * form->unit;
    pose->position[2] *= side;
  }
  if (turning > 0) {
    q[1] *= side;
    q[2] *= side;
    memcpy(pose->orientation, q, sizeof q);
  }
  return place > 0 ? 2 : 1;
}

int osc_form_read(const osc_form* form, const osc_message* message, osc_pose* pose, char* error,
                  size_t size) {
  for (int i = 0; i < form->count; ++i) {
    if (strcmp(message->address, form->entries[i].address) != 0 || !is_of(form, message)) continue;
    const size_t own = strlen(message->types) - (form->serial[0] != '\0' ? 1 : 0);
    switch (form->entries[i].what) {
      case OSC_POSITION:
        return read_pose(form, message, 3, 0, pose, error, size);
      case OSC_ROTATION:
        return read_pose(form, message, 0, own == 3 ? 3 : 4, pose, error, size);
      case OSC_POSE:
        return read_pose(form, message, 3, own == 6 ? 3 : 4, pose, error, size);
    }
  }
  return 0;
}
