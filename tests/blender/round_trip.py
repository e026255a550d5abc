# Reads in Blender what slosh exported of the mug scene, and holds it against the scene's own export.
# Usage: blender --background --python round_trip.py -- MUG.glb FRAMES SPACING
# FRAMES has all kinds of frame 0, in which the water is still in the mug. Exits 1 with a sentence where something is not
# as it should be.
import csv
import sys

import bmesh
import bpy
import numpy
from mathutils import Vector

# Blender 3.4's glTF importer asks numpy for a name that numpy 1.24, Debian 12's, has no more.
numpy.__dict__.setdefault("bool", bool)

scene_file, frames, spacing = sys.argv[sys.argv.index("--") + 1:]
spacing = float(spacing)


def must(truth, sentence):
    if not truth:
        print("round_trip.py: " + sentence)
        sys.exit(1)


def imported(read):
    """The objects that `read` adds."""
    before = set(bpy.data.objects)
    read()
    return [thing for thing in bpy.data.objects if thing not in before]


def corners(thing):
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    places = [thing.matrix_world @ v.co for v in mesh.vertices]
    must(places, f"{thing.name} has no vertices")
    evaluated.to_mesh_clear()
    return (Vector(min(p[i] for p in places) for i in range(3)), Vector(max(p[i] for p in places) for i in range(3)))


def solid(thing):
    """Volume, and edges that have not two faces."""
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    work = bmesh.new()
    work.from_mesh(evaluated.to_mesh())
    volume, loose = work.calc_volume(signed=True), sum(1 for edge in work.edges if len(edge.link_faces) != 2)
    work.free()
    return volume, loose


bpy.ops.wm.read_factory_settings(use_empty=True)
things = {thing.name: thing for thing in imported(lambda: bpy.ops.import_scene.gltf(filepath=scene_file))}
mug_low, mug_high = corners(things["mug"])
with open(frames + "/frames.csv", newline="") as table:
    first = next(csv.DictReader(table))
particle_volume = float(first["particle_volume_m3"])

kinds = {}
kinds["particles.ply"] = imported(lambda: bpy.ops.import_mesh.ply(filepath=frames + "/particles_00000.ply"))[0]
must(len(kinds["particles.ply"].data.vertices) == int(first["particles"]), "particles are missing in Blender")
kinds["surface.ply"] = imported(lambda: bpy.ops.import_mesh.ply(filepath=frames + "/surface_00000.ply"))[0]
kinds["surface.glb"] = imported(lambda: bpy.ops.import_scene.gltf(filepath=frames + "/surface_00000.glb"))[0]
must(kinds["surface.glb"].data.materials[0].name.startswith("water"), "the .glb's material has another name")

volume = bpy.data.volumes.new("fluid")
volume.filepath = frames + "/surface_00000.vdb"
must(volume.grids.load(), "Blender cannot load the .vdb: " + volume.grids.error_message)
grids = {grid.name: grid.data_type for grid in volume.grids}
must(grids == {"surface": "FLOAT", "velocity": "VECTOR_FLOAT", "pressure": "FLOAT"}, f"the .vdb's grids are {grids}")
source = bpy.data.objects.new("volume", volume)
bpy.context.scene.collection.objects.link(source)
meshed = bpy.data.objects.new("meshed", bpy.data.meshes.new("meshed"))
bpy.context.scene.collection.objects.link(meshed)
modifier = meshed.modifiers.new("mesh", "VOLUME_TO_MESH")
modifier.object, modifier.grid_name, modifier.threshold = source, "surface", 0.0
bpy.context.view_layer.update()
# Blender puts a voxel's value in the middle of the cell behind it (its T85312), OpenVDB on the voxel.
half = 0.5 * volume.grids["surface"].matrix_object[0][0]
must(abs(half - spacing / 6) < 1e-6, f"a voxel of {2 * half} m")
source.location = (-half, -half, -half)  # the mesh follows it
bpy.context.view_layer.update()
kinds["surface.vdb"] = meshed

for name, thing in kinds.items():
    low, high = corners(thing)
    for axis in range(3):
        # A spacing of room: once it is settled the mug hangs a little lower in the hand than it was exported.
        must(mug_low[axis] - spacing < low[axis] and high[axis] < mug_high[axis],
             f"{name} is not in the mug along {'xyz'[axis]}: {low} to {high}, the mug {mug_low} to {mug_high}")
    if name == "particles.ply":
        continue
    size, loose = solid(thing)
    must(loose == 0, f"{name} has {loose} edges without two faces")
    # A .vdb's level set is meshed anew.
    must(abs(size / particle_volume - 1) < (0.02 if name == "surface.vdb" else 0.01),
         f"{name} holds {size / particle_volume:.4f} of the particles' volume")
    ply_low, ply_high = corners(kinds["surface.ply"])
    must((low - ply_low).length < 0.1 * spacing and (high - ply_high).length < 0.1 * spacing,
         f"{name} lies elsewhere than surface.ply: {low} to {high}, not {ply_low} to {ply_high}")
    print(f"round_trip.py: {name}: {1e3 * size:.4f} l of {1e3 * particle_volume:.4f} l of particles, {low} to {high}")
attributes = {a.name for a in kinds["surface.glb"].data.attributes}
print(f"round_trip.py: the .glb's attributes in Blender: {sorted(attributes)}")
