"""A mug of water over a bowl, from an empty file to an export that slosh plays.

Usage: blender --background --python mug.py -- FILE.glb [FILE.blend]

It does what a person does with the mouse, in the same order: model closed meshes, say by custom properties what each
is, hang a grip on the mug, animate a hand, set up a camera, export. README.md beside it explains each step.
"""
import math
import os
import sys

import bmesh
import bpy
from mathutils import Vector


def turned(name, profile, place, sides=48):
    """A closed solid of revolution about z: `profile` is a list of (radius, height) that begins and ends on the axis."""
    work = bmesh.new()
    rings = []
    for radius, height in profile:
        corners = 1 if radius == 0 else sides
        rings.append([work.verts.new((radius * math.cos(2 * math.pi * i / corners),
                                      radius * math.sin(2 * math.pi * i / corners), height)) for i in range(corners)])
    for low, high in zip(rings, rings[1:]):
        for i in range(sides):
            face = [low[i % len(low)], low[(i + 1) % len(low)], high[(i + 1) % len(high)], high[i % len(high)]]
            work.faces.new(list(dict.fromkeys(face)))
    bmesh.ops.recalc_face_normals(work, faces=work.faces)
    mesh = bpy.data.meshes.new(name)
    work.to_mesh(mesh)
    work.free()
    thing = bpy.data.objects.new(name, mesh)
    thing.location = place
    bpy.context.scene.collection.objects.link(thing)
    return thing


def painted(thing, red, green, blue, alpha=1.0):
    material = bpy.data.materials.new(thing.name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (red, green, blue, 1.0)
    shader.inputs["Alpha"].default_value = alpha
    material.blend_method = "BLEND" if alpha < 1.0 else "OPAQUE"
    thing.data.materials.append(material)


def empty(name, place, parent=None):
    thing = bpy.data.objects.new(name, None)
    thing.empty_display_size = 0.03
    thing.location = place
    thing.parent = parent
    bpy.context.scene.collection.objects.link(thing)
    return thing


def build():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = 60  # the hand is exported as often: at 24 it would hum
    scene.frame_start, scene.frame_end = 0, 180

    # What can be touched: closed meshes, walls of 12 mm (thinner ones need finer particles).
    mug = turned("mug", [(0, 0), (0.057, 0), (0.057, 0.12), (0.045, 0.12), (0.045, 0.012), (0, 0.012)], (-0.05, 0, 0.16))
    mug["slosh"], mug["motion"], mug["mass_kg"] = "body", "free", 0.3
    painted(mug, 0.75, 0.75, 0.78, 0.35)
    bowl = turned("bowl", [(0, 0), (0.135, 0), (0.135, 0.08), (0.12, 0.08), (0.12, 0.015), (0, 0.015)], (0.08, 0, 0))
    bowl["slosh"] = "body"
    painted(bowl, 0.45, 0.30, 0.18)

    # What flows: a closed mesh that starts full, inside the mug.
    water = turned("water", [(0, 0.0125), (0.0445, 0.0125), (0.0445, 0.095), (0, 0.095)], mug.location)
    water["slosh"] = "fluid"

    # Where a hand takes hold: an empty that is the mug's child.
    grip = empty("handle", (-0.07, 0, 0.06), mug)
    grip["slosh"] = "grip"

    # The hand: an animated empty that names its grip, where the grip is at first.
    hand = empty("hand", mug.location + grip.location)
    hand["slosh"], hand["grip"] = "hand", "handle"
    held = hand.location.copy()
    for frame, angle, aside in ((0, 0, 0.0), (30, 0, 0.0), (110, 110, 0.06), (180, 110, 0.06)):
        hand.location = held + Vector((aside, 0, 0.3 * aside))
        hand.rotation_euler = (0, math.radians(angle), 0)
        hand.keyframe_insert("location", frame=frame)
        hand.keyframe_insert("rotation_euler", frame=frame)

    scene["title"] = "A mug is emptied into a bowl"
    scene["duration_s"] = 3.0
    scene["settle_s"] = 1.0  # the run begins with the water and the mug at rest in the hand

    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = (0.28, -0.72, 0.5)
    camera.rotation_euler = (Vector((0.0, 0.0, 0.12)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    scene.camera = camera


def main():
    files = sys.argv[sys.argv.index("--") + 1:]
    build()
    # File > Export > glTF: Custom Properties, Cameras, Apply Modifiers, +Y Up, Animation on.
    bpy.ops.export_scene.gltf(filepath=files[0], export_format="GLB", export_extras=True, export_cameras=True,
                              export_apply=True, export_yup=True, export_animations=True)
    if len(files) > 1:
        bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(files[1]))


main()
