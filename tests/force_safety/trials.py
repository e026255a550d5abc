"""The kinds of trial: who holds the bucket, what is done to them, and what an undisturbed run of the same people is."""

import math
import random

LENGTH = 6.0  # s of a trial after the world started


class Kind:
    """One way to disturb. `people`: a device a grip. `disturb(random)`: [(s, what, who, ...)], sorted by time.

    Its control is the run of the same people and `steady` commands without `disturb`. `sags`: m that what is held may
    hang lower, on a spring that was softened. `alone`: one hand may come to carry all: times a run without the other.
    `gives`: m over which a silent hand may go on with the force of a weight that was taken away (kHoldWay)."""

    def __init__(self, name, people, disturb, steady=(), sags=0.0, alone=0.0, gives=0.0):
        self.name, self.people, self.disturb, self.steady = name, people, disturb, list(steady)
        self.sags, self.alone, self.gives = sags, alone, gives

    @property
    def control(self):
        return (tuple(self.people), tuple(self.steady))


def stops(*who, count=(1, 4), seconds=(0.05, 0.5), begin=0.8):
    """Pulses in which a process does not run at all: a laptop that swaps, a debugger, a suspended machine."""
    def disturb(rng):
        found = []
        for _ in range(rng.randint(*count)):
            at = rng.uniform(begin, LENGTH - 1.5)
            found.append((at, "stop", rng.choice(who), rng.uniform(*seconds)))
        return sorted(found)
    return disturb


def quota(*who, share=(0.25, 0.6), seconds=2.5):
    """A process that gets a share of a core, in turns of 30 ms."""
    def disturb(rng):
        target, part, at = rng.choice(who), rng.uniform(*share), rng.uniform(0.8, LENGTH - seconds - 0.5)
        return [(at + 0.03 * i, "stop", target, 0.03 * (1.0 - part)) for i in range(int(seconds / 0.03))]
    return disturb


def lines(make):
    """Commands typed at the host or a peer: make(rng) gives (s, who, text)."""
    return lambda rng: sorted((at, "type", who, text) for at, who, text in make(rng))


def both(first, second):
    return lambda rng: sorted(first(rng) + second(rng))


def release(who, grip, gap=(0.1, 1.0)):
    def make(rng):
        at = rng.uniform(1.0, 3.5)
        return [(at, who, f"release {grip}"), (at + rng.uniform(*gap), who, f"take {grip}")]
    return lines(make)


def stiffness(grip):
    """Stiffened while strained, softened, paused in between; toggled in turns."""
    def make(rng):
        found, at = [], rng.uniform(0.8, 1.5)
        for _ in range(rng.randint(2, 6)):
            found.append((at, "host", f"set stiffness {grip} {rng.choice((0.05, 0.3, 1, 4))}"))
            if rng.random() < 0.4:
                found += [(at + 0.02, "host", "pause"), (at + 0.12, "host", "continue")]
            at += rng.choice((0.05, 0.2, 0.6))
        return found
    return lines(make)


def pauses(rng):
    at = rng.uniform(1.0, 3.0)
    return sorted((at + 0.7 * i + late, "type", "host", text) for i in range(2)
                  for late, text in ((0.0, "pause"), (rng.uniform(0.05, 0.5), "continue")))


def resets(rng):
    return sorted((rng.uniform(1.0, 4.0), "type", "host", "reset") for _ in range(rng.randint(1, 3)))


# What everybody feels changes the weight itself: their control has it, too.
GRAVITY = [(1.5 + 0.055 * i, "type", "host", f"set gravity {2 * (i % 2)}") for i in range(20)] + [
    (2.7, "type", "host", "set gravity 1")]
VISCOSITY = [(1.5 + 0.1 * i, "type", "host", f"set viscosity {(0.001, 5)[i % 2]}") for i in range(20)]


def shaking(t, start):  # at 10 Hz
    return [start[0] + 0.004 * math.sin(20 * math.pi * t) * min(t, 1.0), start[1], start[2]]


def jumping(t, start):  # by 0.3 m and back
    return [start[0], start[1] + (0.3 if 2.0 < t < 3.5 else 0.0), start[2]]


def far(t, start):  # a broken tracker: 100 m away for half a second
    return [start[0] + (100.0 if 2.0 < t < 2.5 else 0.0), start[1], start[2]]


MOTIONS = {"shaking": shaking, "jumping": jumping, "far": far}

ALONE, PAIR = ("script",), ("script", "script")
BRACED = "operator:wrist=40"  # N·m/rad: a loose wrist is bent by 50° here, and springs back whenever a force goes
ARM, ARMS = (BRACED,), (BRACED, BRACED)
CARRIES_ALL = 1.1
# m: such an arm springs up by as much when a gap takes the weight away (800 N/m), and the bucket with it.
SPRINGS = 0.04
# Two arms lean against each other, and any split of the weight between them is a rest: each has a lone arm's bound.
ANY_SPLIT = 1.5


def kinds():
    found = []
    for name, people in (("alone", ALONE), ("arm", ARM), ("pair", PAIR), ("arms", ARMS)):
        peers = [f"peer{i}" for i in range(len(people))]
        split = ANY_SPLIT if name == "arms" else 0.0
        found += [
            Kind(f"{name}: host stops", people, stops("host"), alone=split),
            Kind(f"{name}: peer stops", people, stops(*peers), alone=split),
            Kind(f"{name}: everything stops", people, stops("host", *peers, count=(3, 6)), alone=split),
            Kind(f"{name}: host at a quota", people, quota("host"), alone=split),
            Kind(f"{name}: peer at a quota", people, quota(*peers), alone=split),
            Kind(f"{name}: stiffness", people, stiffness("left_hand"), sags=0.4, alone=split or CARRIES_ALL),
            Kind(f"{name}: pauses", people, lambda rng: pauses(rng), alone=split),
            Kind(f"{name}: resets", people, lambda rng: resets(rng), alone=split),
        ]
    for name, people in (("pair", PAIR), ("arms", ARMS)):
        whole = ANY_SPLIT if name == "arms" else CARRIES_ALL
        found += [
            Kind(f"{name}: let go and taken again", people, release("peer0", "left_hand"), alone=whole),
            Kind(f"{name}: let go, taken, and stops", people, both(release("peer0", "left_hand"), stops("host", "peer1")), alone=whole),
            Kind(f"{name}: a partner falls silent", people, stops("peer1", count=(1, 1), seconds=(1.5, 2.5)), alone=whole),
        ]
    for motion in MOTIONS:
        for name, person in (("pair", "script"), ("arms", BRACED)):
            found.append(Kind(f"{name}: {motion} partner, stops", (person, motion), stops("host", "peer0", "peer1"),
                              alone=ANY_SPLIT if person == BRACED else 0.0))
    found += [Kind("pair: gravity 0 and 2, stops", PAIR, stops("host", "peer0", "peer1"), GRAVITY, gives=0.2),
              Kind("pair: viscosity, stops", PAIR, stops("host", "peer0", "peer1"), VISCOSITY)]
    return found
