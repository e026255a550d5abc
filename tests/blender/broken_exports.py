# Makes a sound scene in Blender, and one export for each thing that people get wrong.
# Usage: blender --background --python broken_exports.py -- FOLDER
# Writes FOLDER/NAME.glb and FOLDER/expected.txt: a line "NAME KIND WORDS", KIND being what `slosh check --json` has to
# find ("error" or a warning's), or "none", and WORDS what it has to say.
import math
import os
import sys

import bmesh
import bpy

folder = sys.argv[sys.argv.index("--") + 1]
os.makedirs(folder, exist_ok=True)
expected = []


def lathe(name, profile, sides=32):
    """A closed surface of revolution about z through (radius, height) points that begin and end on the axis."""
    mesh = bpy.data.meshes.new(name + "_mesh")
    work = bmesh.new()
    rings = []
    for radius, height in profile:
        if radius < 1e-9:
            rings.append([work.verts.new((0, 0, height))])
        else:
            rings.append([work.verts.new((radius * math.cos(2 * math.pi * i / sides),
                                          radius * math.sin(2 * math.pi * i / sides), height)) for i in range(sides)])
    for a, b in zip(rings, rings[1:]):
        for i in range(sides):
            j = (i + 1) % sides
            corners = [a[i % len(a)], a[j % len(a)], b[j % len(b)], b[i % len(b)]]
            work.faces.new(list(dict.fromkeys(corners)))
    bmesh.ops.recalc_face_normals(work, faces=work.faces)
    work.to_mesh(mesh)
    work.free()
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def empty(name, place, parent=None):
    thing = bpy.data.objects.new(name, None)
    bpy.context.scene.collection.objects.link(thing)
    thing.location = place
    thing.parent = parent
    return thing


def sound_scene():
    """A mug of water over a table, held by one animated hand, seen by a camera."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = 60
    scene.frame_start, scene.frame_end = 0, 120
    things = {}
    mug = lathe("mug", [(0, 0), (0.05, 0), (0.05, 0.12), (0.035, 0.12), (0.035, 0.015), (0, 0.015)])
    mug.location = (0, 0, 0.3)
    mug["slosh"], mug["motion"], mug["mass_kg"] = "body", "free", 0.4
    water = lathe("water", [(0, 0.016), (0.034, 0.016), (0.034, 0.1), (0, 0.1)])
    water.location = mug.location
    water["slosh"] = "fluid"
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, -0.02), scale=(0.6, 0.6, 0.04))
    table = bpy.context.object
    table.name = "table"
    table["slosh"] = "body"
    grip = empty("handle", (0.07, 0, 0.06), mug)
    grip["slosh"] = "grip"
    hand = empty("hand", (0.07, 0, 0.36))
    hand["slosh"], hand["grip"] = "hand", "handle"
    for frame, angle in ((0, 0.0), (30, 0.0), (90, 1.6), (120, 1.6)):
        hand.rotation_euler = (0, angle, 0)
        hand.location = (0.07, 0.02 * math.sin(angle), 0.36)
        hand.keyframe_insert("rotation_euler", frame=frame)
        hand.keyframe_insert("location", frame=frame)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    camera.location = (0.5, -0.9, 0.7)
    camera.rotation_euler = (math.radians(62), 0, math.radians(29))
    scene.camera = camera
    things.update(mug=mug, water=water, table=table, grip=grip, hand=hand, camera=camera)
    return things


def export(name, kind, words="", **options):
    settings = dict(export_format="GLB", export_extras=True, export_cameras=True, export_animations=True,
                    export_apply=True, export_yup=True)
    settings.update(options)
    bpy.context.view_layer.update()
    bpy.ops.export_scene.gltf(filepath=os.path.join(folder, name + ".glb"), **settings)
    expected.append(f"{name} {kind} {words}".strip())


sound_scene()
export("sound", "none")
sound_scene()
export("no_camera", "no-camera", "Include > Cameras", export_cameras=False)
sound_scene()
export("on_its_side", "on-its-side", "+Y Up", export_yup=False)
sound_scene()
export("no_animation", "no-animation", "1 key", export_animations=False)
sound_scene()
export("no_properties", "error", "custom properties on", export_extras=False)
sound_scene()
bpy.context.scene["gravity_m_s2"] = [0.0, 0.0, -9.81]
export("gravity_z_up", "gravity-not-down", "(0, -9.81, 0)")

t = sound_scene()
# Solidify left out: the mug is one sheet.
t["mug"].data = lathe("sheet", [(0, 0), (0.05, 0), (0.05, 0.12)]).data
bpy.data.objects.remove(bpy.data.objects["sheet"])
t["mug"].modifiers.new("Solidify", "SOLIDIFY").thickness = 0.015
export("solidify_left_out", "error", "Apply Modifiers", export_apply=False)

t = sound_scene()
# Subdivision left out: a coarse block that is shaded round.
bpy.ops.mesh.primitive_cube_add(size=0.1, location=(0.2, 0.2, 0.2))
block = bpy.context.object
block.name = "pebble"
block["slosh"], block["motion"], block["mass_kg"] = "body", "free", 0.1
bpy.ops.object.shade_smooth()
block.modifiers.new("Subdivision", "SUBSURF").levels = 3
export("subdivision_left_out", "coarse-and-smooth", "pebble", export_apply=False)
export("subdivision_applied", "none")

t = sound_scene()
bpy.context.scene.render.fps = 24
bpy.context.scene.frame_end = 48
for curve in t["hand"].animation_data.action.fcurves:
    for key in curve.keyframe_points:
        key.co.x *= 24 / 60
export("keys_at_24_hz", "coarse-keys", "24 keys a second")

t = sound_scene()
for thing in (t["mug"], t["water"], t["table"], t["hand"]):
    thing.location = [10 * x for x in thing.location]
    thing.scale = [10 * x for x in thing.scale]
for curve in t["hand"].animation_data.action.fcurves:
    if curve.data_path == "location":
        for key in curve.keyframe_points:
            key.co.y *= 10
export("ten_times_too_large", "large", "6 x 6 x 4.6 m")

t = sound_scene()
for thing in (t["mug"], t["water"], t["table"], t["hand"]):
    thing.location = [0.1 * x for x in thing.location]
    thing.scale = [0.1 * x for x in thing.scale]
for curve in t["hand"].animation_data.action.fcurves:
    if curve.data_path == "location":
        for key in curve.keyframe_points:
            key.co.y *= 0.1
export("ten_times_too_small", "small", "0.06 x 0.06")

t = sound_scene()
del t["water"]["slosh"]
t["water"]["Slosh"] = "fluid"
export("capital", "capital", "'Slosh'")

t = sound_scene()
del t["water"]["slosh"]
t["water"].data["slosh"] = "fluid"
export("on_mesh_data", "on-mesh-data", "water_mesh")

t = sound_scene()
# The mug's collection is instanced beside it.
group = bpy.data.collections.new("mugs")
bpy.context.scene.collection.children.link(group)
bpy.context.scene.collection.objects.unlink(t["table"])
group.objects.link(t["table"])
instance = empty("second_table", (1.0, 0, 0))
instance.instance_type, instance.instance_collection = "COLLECTION", group
export("collection_instance", "error", "Make Instances Real")

t = sound_scene()
work = bmesh.new()
work.from_mesh(t["mug"].data)
work.faces.ensure_lookup_table()
work.faces.remove(work.faces[40])
work.to_mesh(t["mug"].data)
work.free()
export("hole", "error", "Blender's world")

t = sound_scene()
for face in t["mug"].data.polygons:
    face.flip()
export("inward", "error", "look inward")

t = sound_scene()
t["mug"]["mass_kg"] = -1.0
t["water"]["viscosity_pa_s"] = "thick"
t["table"]["slosh"] = "boddy"
export("three_at_once", "error", "boddy")

t = sound_scene()
t["grip"].parent = None
export("grip_without_a_body", "error", "not the child of a body")

t = sound_scene()
t["hand"]["grip"] = "handel"
export("hand_names_no_grip", "error", "handel")

t = sound_scene()
for curve in t["hand"].animation_data.action.fcurves:
    if curve.data_path == "location":
        for key in curve.keyframe_points:
            key.co.y += 0.2
export("hand_starts_elsewhere", "error", "mm from its grip")

t = sound_scene()
t["mug"].keyframe_insert("location", frame=0)
t["mug"].location.x = 0.1
t["mug"].keyframe_insert("location", frame=60)
export("animated_body", "error", "only a hand can be animated")

t = sound_scene()
t["camera"].data.type = "ORTHO"
export("orthographic", "error", "perspective")

t = sound_scene()
del t["mug"]["mass_kg"]
export("no_mass", "error", "mass_kg")

with open(os.path.join(folder, "expected.txt"), "w") as out:
    out.write("\n".join(expected) + "\n")
