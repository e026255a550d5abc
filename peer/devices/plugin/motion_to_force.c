/* A device of no hardware that measures how long own motion takes to become force, through whatever lies
 * behind it: a handle held so firmly that no force moves it, which goes 2 mm to and fro, each way begun at a
 * known instant of the clock. The force that answers changes against the way. OPTIONS: a file for one line a way
 * (default: none). What came out is told on standard error when it is closed.
 *
 * It moves as a hand can, and does not jump: who jumps works against no force, and a guard that counts what a
 * hand put in (peer/replica) gives it none. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "peer/devices/plugin/slosh_device.h"

#define MOST_JUMPS 20000
static const double kWay = 0.002;      /* m */
static const double kSpeed = 0.2;      /* m/s */
static const double kFirst = 6.0;      /* s: the engagement ramp is over by then, over a long way too */
static const double kApart = 0.1;      /* s from one beginning to the next, */
static const double kChance = 0.05;    /* and up to so much more */
static const double kAnswer = 0.1;     /* N that the force changes against the way */
static const double kGivenUp = 0.08;   /* s after which a way counts as not answered */

typedef struct answer {
  double instant_s; /* that motion began, since the device was opened */
  double motion_ms; /* from then to the write that answers */
  double read_ms;   /* from the reading that told of it */
  int writes;       /* after that reading, with the one that answers */
} answer;

typedef struct handle {
  char file[1024];
  double opened_s;
  double next_s;  /* of the next beginning */
  int ways;
  int side;       /* 0 or 1: where it goes, times kWay */
  double told_s;  /* a reading told of the last beginning then */
  int waiting;    /* for its answer */
  int writes;
  double force;   /* N along x: of the last write, */
  double before;  /* and of the last one before this way */
  double began_s;
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
    h->began_s = h->next_s;
    h->side = 1 - h->side;
    h->ways += 1;
    h->before = h->force;
    h->waiting = 1;
    h->told_s = now;
    h->writes = 0;
    h->next_s = now + kApart + kChance * chance(h);
  }
  memset(reading, 0, sizeof *reading);
  reading->orientation_wxyz[0] = 1.0;
  if (h->ways > 0) {
    const double gone = kSpeed * (now - h->began_s) < kWay ? kSpeed * (now - h->began_s) : kWay;
    reading->position_m[0] = h->side ? gone : kWay - gone;
    reading->velocity_m_s[0] = gone < kWay ? (h->side ? kSpeed : -kSpeed) : 0.0;
  }
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
  if (now - h->began_s > kGivenUp) {
    h->waiting = 0;
    h->missed += 1;
  } else if (against > kAnswer) {
    h->waiting = 0;
    if (h->count < MOST_JUMPS) {
      answer* a = &h->answers[h->count++];
      a->instant_s = h->began_s - h->opened_s;
      a->motion_ms = 1e3 * (now - h->began_s);
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

/* ms in which so much of the answers had come, of answers in the order of their time. */
static double motion_of_share(const handle* h, double share) {
  const int rank = (int)ceil(share * h->count);
  return h->answers[rank > 1 ? rank - 1 : 0].motion_ms;
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
    fprintf(stderr, "motion_to_force: no force answered; it needs %g s and somebody it may hold a body for\n",
            kFirst);
  } else {
    qsort(h->answers, (size_t)h->count, sizeof h->answers[0], by_motion);
    fprintf(stderr,
            "motion_to_force: %d ways of %g mm at %g m/s, %d not answered within %g ms; from motion to force "
            "median %.2f ms, p99 %.2f ms, longest %.2f ms\n",
            h->ways, 1e3 * kWay, kSpeed, h->missed, 1e3 * kGivenUp, motion_of_share(h, 0.5),
            motion_of_share(h, 0.99), motion_of_share(h, 1.0));
  }
  free(h);
}
