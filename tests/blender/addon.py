# The add-on in the real Blender, as a person installs and uses it: from its .zip, kinds by the menu, fields by its buttons,
# Check and Play. Usage: blender --background --python addon.py -- ADDON.zip SLOSH FOLDER
# Exits 1 with a sentence where something is not as it should be.
import os
import sys

import bpy

archive, program, folder = sys.argv[sys.argv.index("--") + 1:]


def must(truth, sentence):
    if not truth:
        print("addon.py: " + sentence)
        sys.exit(1)


bpy.ops.preferences.addon_install(filepath=archive)
bpy.ops.preferences.addon_enable(module="slosh_addon")
from slosh_addon import panel  # noqa: E402 (only now it is there)
from slosh_addon.fields import FIELDS, KINDS  # noqa: E402
from slosh_addon.objects import give  # noqa: E402

os.environ.pop("SLOSH", None)
os.environ["PATH"] = "/usr/bin:/bin"
scene, manager = bpy.context.scene, bpy.context.window_manager


def tried(operator, **options):
    """What Blender tells the person; empty where the operator went through."""
    try:
        operator(**options)
    except RuntimeError as error:
        return str(error)
    return ""


must("slosh was not found" in tried(bpy.ops.slosh.check), "a missing program is not told")
bpy.context.preferences.addons["slosh_addon"].preferences.program = program

# An empty file: the default cube and light go, one mug and what belongs to it come.
for thing in list(scene.objects):
    if thing.type != "CAMERA":
        bpy.data.objects.remove(thing)


def block(name, size, place):
    bpy.ops.mesh.primitive_cube_add(size=1, location=place, scale=size)
    thing = bpy.context.object
    thing.name = name
    return thing


def empty(name, place, parent=None):
    thing = bpy.data.objects.new(name, None)
    thing.location = place
    thing.parent = parent
    scene.collection.objects.link(thing)
    return thing


def active(thing):
    bpy.context.view_layer.objects.active = thing
    bpy.context.view_layer.update()


table = block("table", (1.0, 1.0, 0.05), (0, 0, -0.025))
paddle = block("paddle", (0.05, 0.05, 0.2), (0.3, 0, 0.2))
bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
water = block("water", (0.2, 0.2, 0.1), (0, 0, 0.055))
handle = empty("handle", (0, 0, 0.1), paddle)
hand = empty("hand", (0.3, 0, 0.3))
probe = empty("tip", (0, 0, 0.5))
gauge = empty("level", (0, 0, 0.05))
region = block("inside", (0.3, 0.3, 0.3), (0, 0, 0.2))
pivot = empty("pivot", (0, 0, 0.1), paddle)
kinds = {table: "body", paddle: "body", water: "fluid", handle: "grip", hand: "hand", probe: "probe", gauge: "gauge",
         region: "region", pivot: "joint"}
for thing, kind in kinds.items():
    active(thing)
    thing.slosh_kind = kind
    must(thing.get("slosh") == kind and thing.slosh_kind == kind, f"{thing.name} is no {kind}")
try:
    gauge.slosh_kind = "body"
    must(False, "an empty may be a body")
except TypeError:
    pass
must(water["fluid"] == "water" and paddle["motion"] == "fixed" and pivot["kind"] == "hinge", "first fields are missing")

# A free body without a mass, a hand without a grip: told in the list, with the object's name.
active(paddle)
bpy.ops.slosh.choose(key="motion", value="free")
active(hand)
scene.render.fps = 24
bpy.ops.slosh.sixty()
must(scene.render.fps == 60, "60 frames a second are not set")
for frame, x in ((1, 0.3), (60, 0.35)):
    hand.location.x = x
    hand.keyframe_insert("location", frame=frame)
bpy.context.scene.frame_set(1)
bpy.ops.slosh.check()
found = {(f.kind, f.thing): f.text + ". " + f.mend for f in manager.slosh_findings}
must("mass_kg" in found.get(("error", "paddle"), ""), f"nothing about the paddle's mass: {found}")
must(("error", "hand") in found, f"nothing about the hand's grip: {found}")
must("to mend" in manager.slosh_result, manager.slosh_result)
bpy.ops.slosh.show(thing="hand")
must(bpy.context.object is hand, "Show does not select")
bpy.ops.slosh.choose(key="grip", value="handle")
active(paddle)
bpy.ops.slosh.add_field(key="mass_kg")
bpy.ops.slosh.add_field(key="duration_s", of_scene=True)
scene["duration_s"] = 0.05
bpy.ops.slosh.check()
must("It plays" in manager.slosh_result and not any(f.kind == "error" for f in manager.slosh_findings),
     f"{manager.slosh_result} {[(f.thing, f.text) for f in manager.slosh_findings]}")

# Play, with the file beside the saved .blend.
bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "panel.blend"))
scene, manager = bpy.context.scene, bpy.context.window_manager
manager.slosh_spacing = 0.02
manager.slosh_arguments = "--headless --no-render --unpaced --yes --out panel-run"
bpy.ops.slosh.play()
must(manager.slosh_result.startswith("Played"), manager.slosh_result)
must(os.path.getsize(os.path.join(folder, "panel-run", "wrenches.csv")) > 100, "no wrenches were written")
manager.slosh_arguments = "--no-such-option"
bpy.ops.slosh.play()
must("no-such-option" in manager.slosh_result and "exit code 2" in manager.slosh_result, manager.slosh_result)

# Every field: at its least and its most it is no error, beyond it is one, and it has a tooltip and a unit.
owners = {"scene": scene, **{kind: bpy.data.objects[name] for name, kind in
                             (("paddle", "body"), ("water", "fluid"), ("handle", "grip"), ("tip", "probe"))}}
count = 0


def filled(first, value):
    return [value] * len(first) if isinstance(first, tuple) else value


for kind, owner in owners.items():
    before = dict(owner.items())
    for beyond in (False, True):
        keys = []
        for key, _, first, least, most, words in FIELDS[kind]:
            if most is None or key == "device":
                continue
            give(owner, key)
            must(owner.id_properties_ui(key).as_dict()["description"].startswith(words), f"{key} has no tooltip")
            owner[key] = filled(first, most * 1.5 + 1.0) if beyond else first if isinstance(first, tuple) else most
            keys.append(key)
        bpy.ops.slosh.check()
        said = [f.text for f in manager.slosh_findings if f.kind == "error"]
        for key in keys if beyond or kind != "scene" else []:  # particles a metre apart are refused for other reasons
            must((key in {text.split()[0] for text in said}) == beyond, f"{kind}.{key}: {'beyond' if beyond else 'at'} its most {said}")
        count += len(keys)
    for key in list(owner.keys()):
        if key in before:
            owner[key] = before[key]
        elif key in {f[0] for f in FIELDS[kind]}:
            del owner[key]

# Of another kind, the fields that it does not know are gone.
active(water)
water.slosh_kind = "region"
must("fluid" not in water and "viscosity_pa_s" not in water, "a region kept a fluid's fields")
water.slosh_kind = "none"
must("slosh" not in water, "nothing is still something")
bpy.ops.preferences.addon_disable(module="slosh_addon")
must(not hasattr(bpy.types.Object, "slosh_kind"), "it leaves something behind")
print(f"addon.py: {len(KINDS)} kinds, {count} values of fields; checked, played and refused as it should")
