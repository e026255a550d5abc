"""Join a host, take hold of a grip, lift it a little, and read what comes back.

Usage: join_a_host.py [FILE]     FILE holds the link; without it a host is started here, on this machine's loopback
"""

import os
import shutil
import subprocess
import sys
import tempfile
import time
from typing import Sequence, Tuple

import slosh


def start_host(folder: str, more: Sequence[str] = ()) -> Tuple["subprocess.Popen[bytes]", str]:
    """`slosh host` as a process of its own, and the file with the links that it wrote."""
    program = os.environ.get("SLOSH_PROGRAM") or shutil.which("slosh")
    if not program:
        sys.exit("there is no program slosh: give its place in SLOSH_PROGRAM, or a file with a link")
    links = os.path.join(folder, "links.txt")
    command = [program, "host", "bucket", "--spacing", "0.0135", "--listen", "127.0.0.1:0", "--links", links]
    command += ["--checkpoint", "none", "--no-supervisor", "--threads", "1", "--wait", "1", *more]
    with open(os.path.join(folder, "host.log"), "wb") as log:
        host = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log)
    for _ in range(1200):
        if os.path.exists(links):
            return host, links
        if host.poll() is not None:
            break
        time.sleep(0.05)
    with open(os.path.join(folder, "host.log")) as said:
        sys.exit("the host did not start:\n" + said.read())


def visit(link_file: str) -> None:
    with slosh.join(link_file=link_file, name="Python", timeout=60.0) as remote:
        grip = remote.held[0] if remote.held else remote.scene.grips[0].name
        print(f"joined '{remote.scene.name}' as {remote.name}, holding {remote.held}, at {1e3 * remote.spacing:.0f} mm")
        weight = sum(body.mass for body in remote.scene.bodies if body.free) * 9.81
        # The first hand that takes hold starts the world; over 2 s it gets all of the weight, as nobody holds the rest.
        while remote.time < 3.0 or not remote.held:
            remote.wait(0.05)
        start = remote.handle(grip)
        x, y, z = start.position
        before = remote.body(remote.scene.grips[0].body).center_of_mass[1]
        remote.hold(grip, slosh.Pose((x, y + 0.02, z), start.orientation))
        until = remote.time + 1.5
        while remote.time < until:
            remote.wait(0.05)
        force = remote.grip(grip).force
        lifted = remote.body(remote.scene.grips[0].body).center_of_mass[1] - before
        felt = remote.samples()
        print(f"at {remote.time:.2f} s: force on the hand {force.round(2)} N, the bucket (without its water, {weight:.1f} N)")
        print(f"lifted by {1e3 * lifted:.1f} mm; {len(felt['time'])} samples, network {remote.network}")
        assert force[1] < -1.0, "what is held pulls down"
        assert lifted > 0.002
        assert len(felt["time"]) > 100 and felt["wrenches"].shape[1] == 6
        while remote.positions.shape[0] == 0:
            remote.wait(0.05)
        print(f"{remote.positions.shape[0]} particles, the highest at {remote.positions[:, 1].max():.3f} m")


def main() -> None:
    if len(sys.argv) > 1:
        visit(sys.argv[1])
        return
    folder = tempfile.mkdtemp()
    host, links = start_host(folder)
    try:
        visit(links)
    finally:
        host.terminate()
        host.wait()
        shutil.rmtree(folder)


if __name__ == "__main__":
    main()
