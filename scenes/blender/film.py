"""A film of a run by Blender's own renderer: the scene's bodies as slosh moved them, the fluid's surface frame by frame.

Usage: blender --background --python film.py -- SCENE.glb RUN FILM.mp4 [--every N] [--samples N] [--size WxH] [--still N]

RUN is the folder of a run with --export surface:vdb and --measure at the rate of the frames. --every N renders each Nth
frame only, --still N one frame, as FILM.png. Saves FILM.blend too, to go on from by hand.
"""
import argparse
import csv
import re
import sys
from pathlib import Path

import bpy
import numpy
from mathutils import Quaternion

# Blender 3.4's glTF importer asks numpy for a name that numpy 1.24, Debian 12's, has no more.
numpy.__dict__.setdefault("bool", bool)

FORMULA = r"(^|[,;\t\r\n])'(?='*[=+\-@\t\r\uff1d\uff0b\uff0d\uff20])"  # net/text/spreadsheet.h


def read_arguments():
    parser = argparse.ArgumentParser(prog="film.py")
    parser.add_argument("scene", type=Path)
    parser.add_argument("run", type=Path)
    parser.add_argument("film", type=Path)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--samples", type=int, default=32)
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--still", type=int)
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:])


def name_in(cell):
    """A name of a table: what a spreadsheet would take for a formula has an apostrophe in front."""
    return re.sub(FORMULA, r"\1", cell)


def move_bodies(run, rate):
    """Keys from bodies.csv, whose axes are y up: Blender's are (x, -z, y)."""
    with open(run / "bodies.csv", newline="") as table:
        for row in csv.DictReader(table):
            thing = bpy.data.objects.get(name_in(row["body"]))
            if thing is None:
                continue
            thing.rotation_mode = "QUATERNION"
            thing.location = (float(row["x_m"]), -float(row["z_m"]), float(row["y_m"]))
            thing.rotation_quaternion = Quaternion(
                (float(row["qw"]), float(row["qx"]), -float(row["qz"]), float(row["qy"])))
            frame = 1 + float(row["time_s"]) * rate
            thing.keyframe_insert("location", frame=frame)
            thing.keyframe_insert("rotation_quaternion", frame=frame)


def add_surface(frames, count):
    """The numbered .vdb files as one volume that changes from frame to frame, and a mesh made of its level set."""
    volume = bpy.data.volumes.new("fluid")
    volume.filepath = str((frames / "surface_00000.vdb").resolve())
    volume.is_sequence = True
    volume.frame_start = 1
    volume.frame_offset = -1  # the first file is number 0
    volume.frame_duration = count
    source = bpy.data.objects.new("fluid volume", volume)
    bpy.context.scene.collection.objects.link(source)
    source.hide_render = True
    surface = bpy.data.objects.new("fluid surface", bpy.data.meshes.new("fluid surface"))
    bpy.context.scene.collection.objects.link(surface)
    to_mesh = surface.modifiers.new("Volume to Mesh", "VOLUME_TO_MESH")
    to_mesh.object = source
    to_mesh.grid_name = "surface"
    to_mesh.threshold = 0.0  # where the level set, the distance to the surface, is 0
    to_mesh.use_smooth_shade = True
    # Blender puts a voxel's value in the middle of the cell behind it, OpenVDB on the voxel: half a voxel apart.
    volume.grids.load()
    half = 0.5 * volume.grids["surface"].matrix_object[0][0]
    source.location = (-half, -half, -half)  # the mesh follows it
    water = bpy.data.materials.new("fluid")
    water.use_nodes = True
    shader = water.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (0.55, 0.8, 0.95, 1.0)
    shader.inputs["Transmission"].default_value = 1.0
    shader.inputs["Roughness"].default_value = 0.02
    shader.inputs["IOR"].default_value = 1.33
    surface.data.materials.append(water)
    to_mesh_material = surface.modifiers.new("material", "NODES")
    to_mesh_material.node_group = material_nodes(water)
    return surface


def material_nodes(material):
    """A mesh made by a modifier has no material of its own: this gives it one."""
    group = bpy.data.node_groups.new("material", "GeometryNodeTree")
    group.inputs.new("NodeSocketGeometry", "Geometry")
    group.outputs.new("NodeSocketGeometry", "Geometry")
    first = group.nodes.new("NodeGroupInput")
    last = group.nodes.new("NodeGroupOutput")
    give = group.nodes.new("GeometryNodeSetMaterial")
    give.inputs["Material"].default_value = material
    group.links.new(first.outputs[0], give.inputs["Geometry"])
    group.links.new(give.outputs["Geometry"], last.inputs[0])
    return group


def add_light():
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy = 3.0
    sun.data.angle = 0.1
    sun.rotation_euler = (0.6, 0.2, 0.5)
    bpy.context.scene.collection.objects.link(sun)
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.75, 0.82, 0.9, 1.0)
    bpy.context.scene.world = world
    bpy.ops.mesh.primitive_plane_add(size=4.0, location=(0.0, 0.0, -0.001))


def main():
    options = read_arguments()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(options.scene))
    scene = bpy.context.scene
    scene.camera = next(thing for thing in scene.objects if thing.type == "CAMERA")
    # Where the fluid was at first is no thing to look at, and hands are not drawn.
    for thing in list(scene.objects):
        if thing.get("slosh") in ("fluid", "hand", "region", "gauge"):
            bpy.data.objects.remove(thing)
    with open(options.run / "frames" / "frames.csv", newline="") as table:
        frames = list(csv.DictReader(table))
    rate = round(int(frames[-1]["frame"]) / float(frames[-1]["time_s"]))
    move_bodies(options.run, rate)
    surface = add_surface(options.run / "frames", int(frames[-1]["frame"]) + 1)
    add_light()
    width, height = (int(part) for part in options.size.split("x"))
    render = scene.render
    render.engine = "CYCLES"
    scene.cycles.samples = options.samples
    scene.cycles.use_denoising = False
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.fps = rate
    scene.frame_start, scene.frame_end, scene.frame_step = 1, int(frames[-1]["frame"]) + 1, options.every
    bpy.ops.wm.save_as_mainfile(filepath=str(options.film.with_suffix(".blend").resolve()))

    scene.frame_set(1 if options.still is None else options.still + 1)
    made = surface.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    print(f"film.py: {len(frames)} frames at {rate} Hz, this one's surface has {len(made.vertices)} vertices")
    if len(made.vertices) == 0:
        sys.exit("film.py: Blender made no surface of the .vdb")
    if options.still is not None:
        render.image_settings.file_format = "PNG"
        render.filepath = str(options.film.with_suffix(".png").resolve())
        bpy.ops.render.render(write_still=True)
        return
    render.image_settings.file_format = "FFMPEG"
    render.ffmpeg.format = "MPEG4"
    render.ffmpeg.codec = "H264"
    render.filepath = str(options.film.resolve())
    bpy.ops.render.render(animation=True)


main()
