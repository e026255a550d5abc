#!/usr/bin/env python3
"""Forces on hands and the motion of what they hold while processes stop, parameters change and partners misbehave.

A host and its peers as programs on loopback hold the shipped bucket. Each trial is disturbed as its kind and its seed
say, and stands beside an undisturbed run of the same people: every hand's peak force and torque and its largest change
in a millisecond, and every body's greatest height, way, speed and spin.

    force_safety.py --slosh build/release/bin/slosh --trials 300 --out trials.csv
    force_safety.py --slosh build/release/bin/slosh --only "pair: host stops" --seed 7

Ends with 1 where a trial goes beyond the bounds, which the table names. A trial takes nine seconds.
"""

import argparse
import csv
import math
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from trials import BRACED, LENGTH, MOTIONS, SPRINGS, kinds  # noqa: E402

GRIPS = ("left_hand", "right_hand")
STARTS = ((-0.143, 0.355, 0.0), (0.143, 0.355, 0.0))  # of the shipped bucket's grips
FACTOR = 1.5        # times the control's peak
SLEW = 20.0         # N in a millisecond: a device's 2·10⁴ N/s
# Repeatability of a control that hardly moves: a bound is never below these.
LEAST = {"force_n": 25.0, "torque_nm": 3.0, "change_n": 5.0, "rise_m": 0.05, "way_m": 0.1, "speed_m_s": 0.5,
         "spin_rad_s": 3.0}


class Program:
    """A program in a folder of its own, whose output goes to a file and whose input is a pipe."""

    def __init__(self, folder, name, arguments, home):
        self.name, self.folder = name, os.path.join(folder, name)
        os.makedirs(self.folder, exist_ok=True)
        self.log = os.path.join(self.folder, "log.txt")
        environment = dict(os.environ, HOME=home, XDG_STATE_HOME=os.path.join(home, name))
        with open(self.log, "wb") as log:
            self.process = subprocess.Popen(arguments, cwd=self.folder, stdin=subprocess.PIPE, stdout=log, stderr=log,
                                            env=environment)

    def says(self, words, seconds=60.0):
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            with open(self.log, "rb") as log:
                if words.encode() in log.read():
                    return
            if self.process.poll() is not None:
                break
            time.sleep(0.01)
        with open(self.log, encoding="utf-8", errors="replace") as log:
            raise RuntimeError(f"{self.name} did not say '{words}': {log.read()[-600:]}")

    def type(self, line):
        try:
            self.process.stdin.write((line + "\n").encode())
            self.process.stdin.flush()
        except BrokenPipeError:
            pass

    def stop(self, running):
        self.process.send_signal(signal.SIGCONT if running else signal.SIGSTOP)

    def end(self):
        if self.process.poll() is None:
            self.stop(True)
            self.process.kill()
        self.process.wait()
        self.process.stdin.close()


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as at:
        at.bind(("127.0.0.1", 0))
        return at.getsockname()[1]


def motion_file(path, motion, start):
    with open(path, "w", encoding="utf-8") as out:
        out.write("time_s,device,x_m,y_m,z_m,qw,qx,qy,qz\n")
        for i in range(int(500 * (LENGTH + 2))):
            x, y, z = motion(0.002 * i, start)
            out.write(f"{0.002 * i:.3f},0,{x:.6f},{y:.6f},{z:.6f},1,0,0,0\n")


def table(path):
    if not os.path.exists(path):
        return []
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def measure(folder, people):
    """The worst of a run over all hands and bodies, by the names of LEAST."""
    worst = dict.fromkeys(LEAST, 0.0)
    for i in range(len(people)):
        if people[i] in MOTIONS:
            continue  # what a broken partner feels is theirs
        felt = people[i] != "script"  # nobody feels a script's, which has no limit of its change
        before = None
        for row in table(os.path.join(folder, f"peer{i}", "out", "wrenches.csv")):
            force = [float(row[a]) for a in ("fx_n", "fy_n", "fz_n")]
            torque = [float(row[a]) for a in ("tx_nm", "ty_nm", "tz_nm")]
            at = float(row["time_s"])
            worst["force_n"] = max(worst["force_n"], math.hypot(*force))
            worst["torque_nm"] = max(worst["torque_nm"], math.hypot(*torque))
            if before and felt:
                ms = max(1e3 * (at - before[0]), 1.0)
                worst["change_n"] = max(worst["change_n"], math.dist(force, before[1]) / ms)
            before = (at, force)
    start = None
    for row in table(os.path.join(folder, "host", "out", "bodies.csv")):
        place = [float(row[a]) for a in ("x_m", "y_m", "z_m")]
        start = start or place
        worst["rise_m"] = max(worst["rise_m"], place[1] - start[1])
        worst["way_m"] = max(worst["way_m"], math.dist(place, start))
        worst["speed_m_s"] = max(worst["speed_m_s"], math.hypot(*(float(row[f"v{a}_m_s"]) for a in "xyz")))
        worst["spin_rad_s"] = max(worst["spin_rad_s"], math.hypot(*(float(row[f"w{a}_rad_s"]) for a in "xyz")))
    return worst


def run(slosh, people, events, folder):
    """Runs the people with these events (from the world's start on) and measures. `folder` is empty."""
    home = os.path.join(folder, "home")
    os.makedirs(home)
    programs = {}
    try:
        programs["host"] = host = Program(folder, "host", [
            slosh, "host", "bucket", "--spacing", "0.0139", "--threads", "1", "--wait", str(len(people)), "--listen",
            f"127.0.0.1:{free_port()}", "--links", "links.txt", "--checkpoint", "none", "--no-supervisor", "--out", "out",
            "--measure", "0.005"], home)
        host.says("hosting")
        for i, kind in enumerate(people):
            device = kind
            name = f"peer{i}"
            if kind in MOTIONS:
                os.makedirs(os.path.join(folder, name))
                motion_file(os.path.join(folder, name, "hand.csv"), MOTIONS[kind], STARTS[i])
                device = "replay:hand.csv"
            programs[name] = Program(folder, name, [
                slosh, "join", "--link-file", os.path.join(host.folder, "links.txt"), "--grip", GRIPS[i], "--device",
                device, "--headless", "--no-render", "--rows", "1000", "--key", "key", "--out", "out"], home)
        host.says("the world starts")
        begin = time.monotonic()
        queue = sorted(list(events) + [(LENGTH, "type", "host", "quit")])
        while queue:
            at, what, who, *rest = queue.pop(0)
            time.sleep(max(begin + at - time.monotonic(), 0.0))
            if what == "stop":
                programs[who].stop(False)
                queue = sorted(queue + [(at + rest[0], "go", who)])
            elif what == "go":
                programs[who].stop(True)
            else:
                programs[who].type(rest[0])
        for program in programs.values():
            program.stop(True)
        for program in programs.values():
            program.process.wait(timeout=60)
    finally:
        for program in programs.values():
            program.end()
    return measure(folder, people)


def bounds(kind, control, alone):
    found = {name: max(FACTOR * control[name], LEAST[name]) for name in LEAST}
    if kind.alone:
        found = {name: max(found[name], kind.alone * alone[name]) for name in LEAST}
    found["change_n"] = max(found["change_n"], SLEW)
    found["rise_m"] += kind.gives
    found["way_m"] += kind.sags + kind.gives + (SPRINGS if BRACED in kind.people else 0.0)
    found["speed_m_s"] += math.sqrt(2.0 * 9.81 * 0.25 * kind.gives)
    found["speed_m_s"] += math.sqrt(2.0 * 9.81 * 0.25 * kind.sags)  # half of the way down and a spring's share of that
    found["spin_rad_s"] += 5.0 * kind.sags  # the turning spring is softened, too
    return found


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--slosh", required=True, help="the program")
    parser.add_argument("--trials", type=int, default=0, help="how many, in turns over the kinds (one of each)")
    parser.add_argument("--seed", type=int, default=1, help="of the first trial; the next ones count on")
    parser.add_argument("--only", default="", help="kinds whose name has this in it")
    parser.add_argument("--out", default="", help="file for the table, one row a trial")
    parser.add_argument("--keep", default="", help="folder for the files of trials that go beyond a bound")
    parser.add_argument("--list", action="store_true", help="the kinds, and nothing more")
    return parser.parse_args(arguments)


def main(arguments):
    options = parse(arguments)
    chosen = [kind for kind in kinds() if options.only in kind.name]
    if options.list or not chosen:
        print("\n".join(kind.name for kind in kinds()))
        return 0 if options.list else 2
    slosh = os.path.abspath(options.slosh)
    count = options.trials or len(chosen)
    rows, controls, beyond, began = [], {}, 0, time.monotonic()
    for trial in range(count):
        kind = chosen[trial % len(chosen)]
        seed = options.seed + trial
        folder = tempfile.mkdtemp(prefix="force-safety-")
        try:
            if kind.control not in controls:
                controls[kind.control] = run(slosh, kind.people, kind.steady, os.path.join(folder, "control"))
            lone = (kind.people[:1], ())
            if kind.alone and lone not in controls:
                controls[lone] = run(slosh, lone[0], [], os.path.join(folder, "alone"))
            events = sorted(kind.disturb(random.Random(seed)) + kind.steady)
            worst = run(slosh, kind.people, events, os.path.join(folder, "trial"))
            most = bounds(kind, controls[kind.control], controls.get(lone))
            broken = [name for name in LEAST if not worst[name] <= most[name]]
            beyond += bool(broken)
            rows.append({"kind": kind.name, "seed": seed, "beyond": " ".join(broken),
                         **{name: f"{worst[name]:.3f}" for name in LEAST},
                         **{f"control_{name}": f"{controls[kind.control][name]:.3f}" for name in LEAST}})
            numbers = ", ".join(f"{worst[name]:.3g} ({controls[kind.control][name]:.3g}) {name}" for name in LEAST)
            left = (time.monotonic() - began) / (trial + 1) * (count - trial - 1)
            print(f"{trial + 1}/{count} {kind.name}, seed {seed}: {numbers}{'  BEYOND ' + ' '.join(broken) if broken else ''}"
                  f"; {left / 60:.0f} min left", flush=True)
            if broken and options.keep:
                shutil.copytree(folder, os.path.join(options.keep, f"{kind.name.replace(': ', '-').replace(' ', '_')}-{seed}"))
        finally:
            shutil.rmtree(folder, ignore_errors=True)
    if options.out:
        with open(options.out, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, rows[0].keys())
            writer.writeheader()
            writer.writerows(rows)
    print(f"{count - beyond} of {count} trials within {FACTOR} times the control")
    return 1 if beyond else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
