/* A device of no hardware that measures how long own motion takes to become force, through whatever lies behind
 * it: a handle held so firmly that no force moves it, which jumps by 2 mm at known instants of the clock. The
 * force that answers changes against the jump. OPTIONS: a file for one line a jump (default: none). What came
 * out is told on standard error when it is closed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "peer/haptics/devices/plugin/slosh_device.h"

#define MOST_JUMPS 20000
static const double kJump = 0.002;     /* m */
static const double kFirst = 6.0;      /* s: taking hold is over by then, over a long way too */
static const double kApart = 0.1;      /* s between two jumps, */
static const double kChance = 0.05;    /* and up to so much more */
static const double kAnswer = 0.1;     /* N that the force changes against the jump */
static const double kGivenUp = 0.08;   /* s after which a jump counts as not answered */

typedef struct answer {
  double instant_s; /* of the jump, since the device was opened */
  double motion_ms; /* from the jump to the write that answers */
  double read_ms;   /* from the reading that told of it */
  int writes;       /* after that reading, with the one that answers */
} answer;

typedef struct handle {
  char file[1024];
  double opened_s;
  double next_s;  /* of the next jump */
  int jumps;
  int side;       /* 0 or 1: where it is, times kJump */
  int told;       /* a reading told of the last jump ... */
  double told_s;  /* ... then */
  int waiting;    /* for its answer */
  int writes;
  double force;   /* N along x: of the last write, */
  double before;  /* and of the last one before the jump */
  double jump_s;
  unsigned chance;
  int count, missed;
  answer answers[MOST_JUMPS];
} handle;

static double now_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* 0 to 1: the same row each time, and in step with no loop. */
static double chance(handle* h) {
  h->chance = h->chance * 1664525u + 1013904223u;
  return (double)(h->chance >> 8) / 16777216.0;
}

uint32_t slosh_device_version(void) { return SLOSH_DEVICE_VERSION; }

int slosh_device_open(const char* options, void** device, char* error, size_t size) {
  handle* made = calloc(1, sizeof *made);
  if (made == NULL || strlen(options) >= sizeof made->file) {
    free(made);
    snprintf(error, size, "%s", made == NULL ? "there is no memory" : "the option's path is too long");
    return -1;
  }
  strcpy(made->file, options);
  made->opened_s = now_s();
  made->next_s = made->opened_s + kFirst;
  made->chance = 1u;
  *device = made;
  return 0;
}

int slosh_device_get_capabilities(void* device, slosh_device_capabilities* c) {
  (void)device;
  memset(c, 0, sizeof *c);
  snprintf(c->name, sizeof c->name, "motion_to_force");
  c->period_s = 0.001;
  c->max_force_n = 20.0;
  c->max_torque_nm = 1.0;
  c->max_force_rate_n_s = 2000.0;
  c->max_torque_rate_nm_s = 100.0;
  c->max_stiffness_n_m = 2000.0;
  c->max_damping_n_s_m = 10.0;
  c->max_rotational_stiffness_nm_rad = 5.0;
  c->max_rotational_damping_nm_s_rad = 0.05;
  c->own_damping_n_s_m = 20.0;
  c->own_rotational_damping_nm_s_rad = 0.1;
  c->workspace_radius_m = 0.2;
  return 0;
}

int slosh_device_read(void* device, slosh_device_reading* reading) {
  handle* h = device;
  const double now = now_s();
  if (now >= h->next_s) {
    if (h->waiting) h->missed += 1;
    h->jump_s = h->next_s;
    h->side = 1 - h->side;
    h->jumps += 1;
    h->before = h->force;
    h->waiting = 1;
    h->told_s = now;
    h->writes = 0;
    h->next_s = now + kApart + kChance * chance(h);
  }
  memset(reading, 0, sizeof *reading);
  reading->position_m[0] = kJump * h->side;
  reading->orientation_wxyz[0] = 1.0;
  reading->flags = SLOSH_READING_HAS_TWIST;
  return 0;
}

int slosh_device_write(void* device, const double force_n[3], const double torque_nm[3]) {
  handle* h = device;
  (void)torque_nm;
  h->force = force_n[0];
  if (!h->waiting) return 0;
  const double now = now_s();
  h->writes += 1;
  const double against = h->side ? h->before - h->force : h->force - h->before;
  if (now - h->jump_s > kGivenUp) {
    h->waiting = 0;
    h->missed += 1;
  } else if (against > kAnswer) {
    h->waiting = 0;
    if (h->count < MOST_JUMPS) {
      answer* a = &h->answers[h->count++];
      a->instant_s = h->jump_s - h->opened_s;
      a->motion_ms = 1e3 * (now - h->jump_s);
      a->read_ms = 1e3 * (now - h->told_s);
      a->writes = h->writes;
    }
  }
  return 0;
}

static int by_motion(const void* a, const void* b) {
  const double x = ((const answer*)a)->motion_ms, y = ((const answer*)b)->motion_ms;
  return (x > y) - (x < y);
}

void slosh_device_close(void* device) {
  handle* h = device;
  if (h->file[0] != '\0') {
    FILE* out = fopen(h->file, "w");
    if (out == NULL) {
      fprintf(stderr, "motion_to_force: %s cannot be written\n", h->file);
    } else {
      fprintf(out, "time_s,motion_to_force_ms,reading_to_force_ms,writes\n");
      for (int i = 0; i < h->count; ++i)
        fprintf(out, "%.6f,%.4f,%.4f,%d\n", h->answers[i].instant_s, h->answers[i].motion_ms, h->answers[i].read_ms,
                h->answers[i].writes);
      fclose(out);
    }
  }
  if (h->count == 0) {
    fprintf(stderr, "motion_to_force: no force answered; it needs %g s and somebody it may hold a body for\n", kFirst);
  } else {
    qsort(h->answers, (size_t)h->count, sizeof h->answers[0], by_motion);
    const answer* a = h->answers;
    fprintf(stderr,
            "motion_to_force: %d jumps of %g mm, %d not answered within %g ms; from motion to force median %.2f ms, "
            "p99 %.2f ms, longest %.2f ms\n",
            h->jumps, 1e3 * kJump, h->missed, 1e3 * kGivenUp, a[h->count / 2].motion_ms,
            a[(h->count - 1) * 99 / 100].motion_ms, a[h->count - 1].motion_ms);
  }
  free(h);
}
