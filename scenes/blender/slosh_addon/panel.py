"""The sidebar's tab "slosh", and the preferences."""
import textwrap

import bpy

from .fields import LEAST_RATE, fields_of
from .objects import AddField, Choose, RemoveField, Show, Sixty, choices, kind_of, owner_of
from .run import Check, Play, Running, Stop, find_program

WIDTH = 27  # letters of a line, as wide as the sidebar is at first

def draw_fields(layout, context, owner, of_scene):
    for key, field in fields_of(kind_of(owner)).items():
        if key not in owner:
            continue
        unit, few = field[1], choices(context, field)
        row = layout.row(align=True)
        if few:
            row.label(text=key)
            for value in few:
                button = row.operator(Choose.bl_idname, text=value, depress=owner[key] == value)
                button.key, button.value, button.of_scene = key, value, of_scene
        else:
            row.prop(owner, f'["{key}"]', text=f"{key} [{unit.replace('2', chr(178)).replace('3', chr(179))}]" if unit else key)
        button = row.operator(RemoveField.bl_idname, text="", icon="X")
        button.key, button.of_scene = key, of_scene
    layout.menu("SLOSH_MT_scene_fields" if of_scene else "SLOSH_MT_object_fields", icon="ADD")


class SloshPanel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "slosh"


class ObjectPanel(SloshPanel, bpy.types.Panel):
    bl_idname = "SLOSH_PT_object"
    bl_label = "This object"

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type in ("MESH", "EMPTY")

    def draw(self, context):
        thing = context.object
        self.layout.label(text=thing.name, icon="OBJECT_DATA")
        self.layout.prop(thing, "slosh_kind", text="is")
        if thing.get("slosh"):
            draw_fields(self.layout, context, thing, False)
        holder = thing.parent
        if thing.get("slosh") == "grip" and (holder is None or holder.get("slosh") not in ("body", "probe")):
            self.layout.label(text="Make it the child of a body (Ctrl P)", icon="ERROR")
        if thing.get("slosh") == "joint" and (holder is None or holder.get("slosh") != "body"):
            self.layout.label(text="Make it the child of one of its bodies (Ctrl P)", icon="ERROR")


class ScenePanel(SloshPanel, bpy.types.Panel):
    bl_idname = "SLOSH_PT_scene"
    bl_label = "The scene"

    def draw(self, context):
        draw_fields(self.layout, context, context.scene, True)
        render = context.scene.render
        if render.fps / render.fps_base < LEAST_RATE:
            self.layout.operator(Sixty.bl_idname, icon="ERROR")


class RunPanel(SloshPanel, bpy.types.Panel):
    bl_idname = "SLOSH_PT_run"
    bl_label = "Check and play"

    def draw(self, context):
        scene, manager, layout = context.scene, context.window_manager, self.layout
        layout.prop(manager, "slosh_spacing")
        layout.prop(manager, "slosh_arguments")
        row = layout.row(align=True)
        row.enabled = Running.child is None
        row.operator(Check.bl_idname, icon="CHECKMARK")
        row.operator(Play.bl_idname, icon="PLAY")
        if Running.child is not None:
            layout.operator(Stop.bl_idname, text=f"Stop ({Running.words})", icon="CANCEL")
        elif manager.slosh_result:
            for line in textwrap.wrap(manager.slosh_result, WIDTH):
                layout.label(text=line)
        for finding in manager.slosh_findings:
            box = layout.box()
            lines = textwrap.wrap(finding.text, WIDTH)
            box.label(text=lines[0] if lines else "", icon="CANCEL" if finding.kind == "error" else "ERROR")
            for line in [*lines[1:], *textwrap.wrap(finding.mend, WIDTH)]:
                box.label(text=line)
            if finding.thing in scene.objects:
                box.operator(Show.bl_idname, text=finding.thing, icon="RESTRICT_SELECT_OFF").thing = finding.thing


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__
    program: bpy.props.StringProperty(name="slosh", subtype="FILE_PATH", description=(
        "The program or the launcher ./slosh; empty: $SLOSH, slosh on the path"))

    def draw(self, _context):
        self.layout.prop(self, "program")
        found = find_program()
        self.layout.label(text=found or "slosh was not found", icon="CHECKMARK" if found else "ERROR")
