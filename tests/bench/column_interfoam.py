#!/usr/bin/env python3
"""The wave on Yeh's and Petroff's column by another solver: OpenFOAM's interFoam (Debian's package openfoam, 1912).

    tests/bench/column_interfoam.py --cells 10 OUT        makes the case in OUT, runs it and reads it
    tests/bench/column_interfoam.py --read OUT            reads one that has run

Half the tank of `slosh report error --case column` (a plane of symmetry down its middle), water let go at once onto 1 cm
of water, laminar, no slip. Printed are what that case reads: when the wave is there (5 N in a mean of 10 ms), the
largest mean over 40 ms, N, and with --until 1.2 the impulse of the first wave, N·s. Until 0.45 s 20 mm take a minute of
one core, 10 mm a quarter of an hour.
"""
import argparse
import bisect
import os
import pathlib
import re
import subprocess
import sys

LENGTH, HALF_WIDTH, HEIGHT, WET = 1.6, 0.305, 0.6, 0.01  # m; open at its top
ALONG = (0.0, 0.9, 1.02, LENGTH)  # the column stands between the second and the third
ACROSS = (0.0, 0.06, HALF_WIDTH)
DAM = (0.4, 0.3)
LASTS = 0.87  # s, for which the experiment's readings go on
FILES = {
    "system/controlDict": """application interFoam; startFrom startTime; startTime 0; stopAt endTime; endTime %(end)g;
deltaT 1e-4; writeControl adjustableRunTime; writeInterval 10; adjustTimeStep yes; maxCo 0.5; maxAlphaCo 0.5; maxDeltaT 0.002;
functions { force { type forces; libs (forces); patches (column); CofR (0 0 0); writeControl timeStep; writeInterval 1; } }""",
    "system/fvSchemes": """ddtSchemes { default Euler; } gradSchemes { default Gauss linear; }
divSchemes { div(rhoPhi,U) Gauss linearUpwind grad(U); div(phi,alpha) Gauss vanLeer; div(phirb,alpha) Gauss linear;
  div(((rho*nuEff)*dev2(T(grad(U))))) Gauss linear; }
laplacianSchemes { default Gauss linear corrected; } interpolationSchemes { default linear; } snGradSchemes { default corrected; }""",
    "system/fvSolution": """solvers {
"alpha.water.*" { nAlphaCorr 2; nAlphaSubCycles 1; cAlpha 1; MULESCorr yes; nLimiterIter 5; solver smoothSolver;
  smoother symGaussSeidel; tolerance 1e-8; relTol 0; }
"pcorr.*" { solver PCG; preconditioner DIC; tolerance 1e-5; relTol 0; }
p_rgh { solver GAMG; smoother DIC; tolerance 1e-6; relTol 0.02; }
p_rghFinal { $p_rgh; relTol 0; }
U { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-6; relTol 0; } }
PIMPLE { momentumPredictor no; nOuterCorrectors 1; nCorrectors 3; nNonOrthogonalCorrectors 0; }""",
    "system/setFieldsDict": """defaultFieldValues ( volScalarFieldValue alpha.water 0 );
regions ( boxToCell { box (0 0 -1) (%(dam_x)g %(dam_y)g 1); fieldValues ( volScalarFieldValue alpha.water 1 ); }
          boxToCell { box (0 0 -1) (2 %(wet)g 1); fieldValues ( volScalarFieldValue alpha.water 1 ); } );""",
    "constant/transportProperties": """phases (water air); water { transportModel Newtonian; nu 1e-6; rho 1000; }
air { transportModel Newtonian; nu 1.48e-5; rho 1; } sigma 0.07;""",
    "constant/turbulenceProperties": "simulationType laminar;",
    "constant/g": "dimensions [0 1 -2 0 0 0 0]; value (0 -9.81 0);",
    "0/U": """dimensions [0 1 -1 0 0 0 0]; internalField uniform (0 0 0); boundaryField { "walls|column" { type noSlip; }
top { type pressureInletOutletVelocity; value uniform (0 0 0); } middle { type symmetryPlane; } }""",
    "0/p_rgh": """dimensions [1 -1 -2 0 0 0 0]; internalField uniform 0; boundaryField {
"walls|column" { type fixedFluxPressure; value uniform 0; } top { type totalPressure; p0 uniform 0; } middle { type symmetryPlane; } }""",
    "0/alpha.water": """dimensions [0 0 0 0 0 0 0]; internalField uniform 0; boundaryField { "walls|column" { type zeroGradient; }
top { type inletOutlet; inletValue uniform 0; value uniform 0; } middle { type symmetryPlane; } }""",
}
CLASSES = {"constant/g": "uniformDimensionedVectorField", "0/U": "volVectorField", "0/p_rgh": "volScalarField",
           "0/alpha.water": "volScalarField"}


def block_mesh(cell):
    """Six blocks beside and behind the column; its own is left out."""
    def vertex(i, j, k):
        return k * 8 + j * 4 + i

    def quad(*corners):
        return "(%d %d %d %d)" % tuple(vertex(*c) for c in corners)

    def cells(low, high):
        return max(1, round((high - low) / cell))

    places = [(x, y, z) for z in ACROSS for y in (0.0, HEIGHT) for x in ALONG]
    blocks, walls, top = [], [], []
    for k in range(2):
        for i in range(3):
            if (i, k) == (1, 0):
                continue
            corners = [(i, 0, k), (i + 1, 0, k), (i + 1, 1, k), (i, 1, k)]
            corners += [(a, b, k + 1) for a, b, _ in corners]
            blocks.append("hex (%s) (%d %d %d) simpleGrading (1 1 1)" % (
                " ".join(str(vertex(*c)) for c in corners), cells(ALONG[i], ALONG[i + 1]), cells(0.0, HEIGHT),
                cells(ACROSS[k], ACROSS[k + 1])))
            walls.append(quad((i, 0, k), (i + 1, 0, k), (i + 1, 0, k + 1), (i, 0, k + 1)))
            top.append(quad((i, 1, k), (i, 1, k + 1), (i + 1, 1, k + 1), (i + 1, 1, k)))
        walls.append(quad((0, 0, k), (0, 0, k + 1), (0, 1, k + 1), (0, 1, k)))
        walls.append(quad((3, 0, k), (3, 1, k), (3, 1, k + 1), (3, 0, k + 1)))
    walls += [quad((i, 0, 2), (i + 1, 0, 2), (i + 1, 1, 2), (i, 1, 2)) for i in range(3)]
    middle = [quad((i, 0, 0), (i, 1, 0), (i + 1, 1, 0), (i + 1, 0, 0)) for i in (0, 2)]
    column = [quad((1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)), quad((2, 0, 0), (2, 0, 1), (2, 1, 1), (2, 1, 0)),
              quad((1, 0, 1), (1, 1, 1), (2, 1, 1), (2, 0, 1))]
    patches = [("walls", "wall", walls), ("top", "patch", top), ("middle", "symmetryPlane", middle),
               ("column", "wall", column)]
    return "scale 1; vertices (%s);\nblocks (%s);\nedges (); boundary (%s); mergePatchPairs ();" % (
        " ".join("(%g %g %g)" % p for p in places), "\n".join(blocks),
        " ".join("%s { type %s; faces (%s); }" % (name, kind, " ".join(faces)) for name, kind, faces in patches))


def make(out, cell, end):
    values = {"end": end, "dam_x": DAM[0], "dam_y": DAM[1], "wet": max(WET, cell)}
    texts = {name: text % values if "%(" in text else text for name, text in FILES.items()}
    texts["system/blockMeshDict"] = block_mesh(cell)
    for name, text in texts.items():
        path = out / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("FoamFile { version 2.0; format ascii; class %s; object %s; }\n%s\n" % (
            CLASSES.get(name, "dictionary"), path.name, text))


def run(out):
    etc = "/usr/share/openfoam"  # as Debian has it
    env = dict(os.environ, WM_PROJECT_DIR=etc, FOAM_ETC=etc + "/etc")
    for program in ("blockMesh", "setFields", "interFoam"):
        print(program, flush=True)
        try:
            with open(out / (program + ".log"), "w") as log:
                subprocess.run([program], cwd=out, env=env, stdout=log, stderr=log, check=True)
        except FileNotFoundError:
            sys.exit("%s: is not installed. apt-get install openfoam." % program)
        except subprocess.CalledProcessError:
            sys.exit("%s: ended early; %s says why." % (program, out / (program + ".log")))


def read(out):
    times, areas, last = [], [], None  # areas: N·s until then, of the whole column
    for path in sorted(out.glob("postProcessing/force/*/force.dat")):
        for line in path.read_text().splitlines():
            if line.startswith("#"):
                continue
            time, along = [float(x) for x in re.findall(r"[-+0-9.eE]+", line)[:2]]
            areas.append(areas[-1] + (along + last) * (time - times[-1]) if times else 0.0)
            times.append(time)
            last = along
    if len(times) < 2:
        sys.exit("%s: has no forces; run it first." % out)

    def until(time):
        i = min(max(bisect.bisect(times, time), 1), len(times) - 1)
        share = (time - times[i - 1]) / (times[i] - times[i - 1])
        return areas[i - 1] + (areas[i] - areas[i - 1]) * share

    def mean(time, window):
        return (until(time + window) - until(time)) / window

    moments = [0.001 * i for i in range(int(1000 * times[-1]))]
    there = next((t for t in moments if t + 0.01 < times[-1] and mean(t, 0.01) > 5.0), None)
    peak = max((mean(t, 0.04), t) for t in moments if t + 0.04 < times[-1])
    print("until %.3f s: wave there %s, peak %.2f N from %.3f s on" % (
        times[-1], "never" if there is None else "%.3f s" % there, *peak))
    if there is None or there + LASTS > times[-1]:
        print("no impulse: that takes %.2f s from then on (--until 1.2)" % LASTS)
    else:
        print("impulse of %.2f s from then on %.2f N·s" % (LASTS, LASTS * mean(there, LASTS)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path, metavar="OUT", help="folder of the case")
    parser.add_argument("--cells", type=float, default=20.0, metavar="MM", help="edge of a cell (%(default)s)")
    parser.add_argument("--until", type=float, default=0.45, metavar="S", help="simulated seconds (%(default)s)")
    parser.add_argument("--read", action="store_true", help="only read what has run")
    options = parser.parse_args()
    if not options.read:
        if not 2.0 <= options.cells <= 60.0:
            parser.error("--cells: 2 to 60 mm")
        if options.out.exists() and any(options.out.iterdir()):
            parser.error("%s: is not empty" % options.out)
        make(options.out, 1e-3 * options.cells, options.until)
        run(options.out)
    read(options.out)


if __name__ == "__main__":
    main()
