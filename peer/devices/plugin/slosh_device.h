/* A haptic device for slosh, as a shared library: implement these six functions, give its path to
 *     slosh play spoon --device plugin:/path/to/libmydevice.so:OPTIONS
 * C only, no library needed. An example: plugin/example.c. A device that measures force and is told where to
 * go (admittance) has a seventh: plugin/admittance.c. One that only tells where it is (a tracker):
 * plugin/osc.
 *
 * Units are SI. The device's frame is right-handed as its user sees it: x to the right, y up, z towards the
 * user; slosh turns it into the world's. Calls come one at a time, though not all from one thread: open and
 * close from helpers, capabilities, read and write from the device's own thread, read and write in turn about
 * once each `period_s`. read may wait for the device, best not longer than a few periods: a plug-in that
 * waits stops no other hand, but its own hand fades after 0.1 s and is taken for gone after 0.4 s. What a
 * plug-in throws, and numbers that are not finite, end or silence its hand with a force of zero. It lives in
 * slosh's process: what it does to memory cannot be contained.
 */
#ifndef SLOSH_DEVICE_H
#define SLOSH_DEVICE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Of this file. Fields are only ever added with a new version; a plug-in of an older one is taken as it is.
 * 2: devices that measure force. 3: devices without force, and slosh_device_say. */
#define SLOSH_DEVICE_VERSION 3u

#if defined(__GNUC__)
#define SLOSH_DEVICE_EXPORT __attribute__((visibility("default")))
#else
#define SLOSH_DEVICE_EXPORT
#endif

#define SLOSH_DEVICE_IMPEDANCE 0u  /* tells where it is, takes a force: slosh_device_write */
#define SLOSH_DEVICE_ADMITTANCE 1u /* tells the hand's force, is told where to go: slosh_device_move */
/* Since version 3: tells where it is and gives no force. Of its capabilities name, period_s and kind count;
 * slosh_device_write is there and not called. */
#define SLOSH_DEVICE_POSITION 2u

/* What the device can hold, by its data sheet. Every number above 0 and finite, or it is refused; a device
 * without torque says what it likes there and passes over what it is sent. */
typedef struct slosh_device_capabilities {
  char name[64];   /* of the model, for messages and its settings file; ends in '\0' */
  double period_s; /* between two readings, e.g. 0.001 */
  double max_force_n;
  double max_torque_nm;
  double max_force_rate_n_s;
  double max_torque_rate_nm_s;
  double max_stiffness_n_m; /* the hardest spring that it renders without humming */
  double max_damping_n_s_m;
  double max_rotational_stiffness_nm_rad;
  double max_rotational_damping_nm_s_rad;
  double own_damping_n_s_m; /* of its mechanics, switched off: what springs it holds depends on it */
  double own_rotational_damping_nm_s_rad;
  double workspace_radius_m;
  /* Since version 2. The rest is for SLOSH_DEVICE_ADMITTANCE alone, every number above 0: slosh moves it as a
   * mass and a damper that the hand and the world push. Its own damping above is that damper's. With a stiff
   * hand it hums unless own_damping_n_s_m > following_s times the hand's stiffness: 4 N s/m at 5 ms and 800
   * N/m. */
  uint32_t kind; /* SLOSH_DEVICE_... */
  double virtual_mass_kg;
  double virtual_inertia_kg_m2; /* 1e6 for one that does not turn */
  double max_speed_m_s;
  double max_turning_rad_s;
  double following_s; /* by which its motion is behind what it is told */
} slosh_device_capabilities;

#define SLOSH_READING_HAS_TWIST 1u  /* velocities are measured; else slosh estimates them */
#define SLOSH_READING_LET_GO 2u     /* the hand is not on the device */
#define SLOSH_READING_HAS_WRENCH 4u /* force and torque are measured; asked of every admittance device */

typedef struct slosh_device_reading {
  double position_m[3];
  double orientation_wxyz[4]; /* unit quaternion; 1 0 0 0 for a device that does not turn */
  double velocity_m_s[3];
  double angular_velocity_rad_s[3];
  uint32_t buttons; /* bit 0 is the first */
  uint32_t flags;   /* SLOSH_READING_... */
  /* Since version 2: of the hand on the device, about the handle, in the device's frame; zero where nobody
   * touches it (take away the handle's weight, and what is noise). */
  double force_n[3];
  double torque_nm[3];
} slosh_device_reading;

/* Since version 2: where an admittance device is to be now, and how fast it goes there. */
typedef struct slosh_device_motion {
  double position_m[3];
  double orientation_wxyz[4];
  double velocity_m_s[3];
  double angular_velocity_rad_s[3];
} slosh_device_motion;

/* SLOSH_DEVICE_VERSION of the header that the plug-in was built with. */
SLOSH_DEVICE_EXPORT uint32_t slosh_device_version(void);

/* `options`: what the user wrote after the path; never null. 0, and *device is handed to the others; else a
 * sentence in `error` (of `size` bytes with its '\0'), shown to the user. */
SLOSH_DEVICE_EXPORT int slosh_device_open(const char* options, void** device, char* error, size_t size);

/* After open. 0, or anything else: it cannot say. */
SLOSH_DEVICE_EXPORT int slosh_device_get_capabilities(void* device, slosh_device_capabilities* capabilities);

/* 0: a new reading. 1: nothing new. Below 0: the device is gone for good. */
SLOSH_DEVICE_EXPORT int slosh_device_read(void* device, slosh_device_reading* reading);

/* The wrench on the hand, within the capabilities, about the handle. 0: taken. Below 0: as for read. */
SLOSH_DEVICE_EXPORT int slosh_device_write(void* device, const double force_n[3], const double torque_nm[3]);

/* Of an admittance device, in place of write, which it has and which is not called: about once each period_s.
 * 0: taken. Below 0: as for read. One that is not renewed for 0.1 s is over: let the device hold still then,
 * as at its last, which has no velocity. */
SLOSH_DEVICE_EXPORT int slosh_device_move(void* device, const slosh_device_motion* motion);

/* Since version 3, may be missing: a sentence about it now, of at most `size` bytes with its '\0', after a
 * read, some ten times a second. 0: how it does ("60 readings a second"). 1: what keeps it from working ("the
 * battery is empty"), in place of what `read` does not say. */
SLOSH_DEVICE_EXPORT int slosh_device_say(void* device, char* words, size_t size);

/* Last; a force of zero was written before, where the device still answered. */
SLOSH_DEVICE_EXPORT void slosh_device_close(void* device);

#ifdef __cplusplus
}
#endif

#endif
