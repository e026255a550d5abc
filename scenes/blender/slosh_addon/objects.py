"""Custom properties of objects and of the scene: what sets, changes and removes them."""
import bpy

from .fields import FIELDS, FIRST, KINDS, fields_of


def kind_of(owner):
    return "scene" if isinstance(owner, bpy.types.Scene) else owner.get("slosh", "")


def give(owner, key):
    """The field with its first value, its unit, range and words in Blender's own tooltip."""
    _, unit, first, least, most, words = fields_of(kind_of(owner))[key]
    value = first[0] if isinstance(first, list) else "" if first in ("name", "body") else first
    owner[key] = value
    about = {"description": words + (f" [{unit}]" if unit else "")}
    if least is not None:
        about.update(min=least, soft_min=least)
    if most is not None:
        about.update(max=most, soft_max=most)
    if isinstance(first, (float, tuple)):
        about["precision"] = 4
    if isinstance(first, bool):
        owner[key] = int(first)  # 3.4 keeps no truth values; slosh takes 0 and 1
        about.update(min=0, max=1)
    owner.id_properties_ui(key).update(**about)
    return value


def set_kind(thing, kind):
    """Makes `thing` a body, a fluid…; '' makes it nothing. Fields that the new kind does not know are taken away."""
    for key in list(thing.keys()):
        if key in fields_of(kind_of(thing)) and key not in fields_of(kind):
            del thing[key]
    if not kind:
        if "slosh" in thing:
            del thing["slosh"]
        return
    thing["slosh"] = kind
    for key in FIRST.get(kind, ()):
        if key not in thing:
            give(thing, key)
    if kind == "fluid" and thing["fluid"] == "water":
        thing["fluid"] = thing.name


def owner_of(context, of_scene):
    return context.scene if of_scene else context.object


def kinds_for(thing, _context):
    return [("none", "nothing", "A mesh is only looked at, an empty is nobody's", 0)] + [
        (name, name, words, i + 1) for i, (name, words, types) in enumerate(KINDS) if thing.type in types]


def set_number_of_kind(thing, number):
    set_kind(thing, KINDS[number - 1][0] if number > 0 else "")


def number_of_kind(thing):
    names = [name for name, _, _ in KINDS]
    return names.index(thing["slosh"]) + 1 if thing.get("slosh") in names else 0


class AddField(bpy.types.Operator):
    """Give this a value of its own"""
    bl_idname = "slosh.add_field"
    bl_label = "Add a field"
    bl_options = {"UNDO", "INTERNAL"}
    key: bpy.props.StringProperty()
    of_scene: bpy.props.BoolProperty()

    @classmethod
    def description(cls, _context, properties):
        _, unit, _, least, most, words = next(f for kind in FIELDS for f in FIELDS[kind] if f[0] == properties.key)
        if most is not None:
            return f"{words}. {least:g} to {most:g} {unit}"
        return f"{words}. At least {least:g} {unit}" if least is not None else words

    def execute(self, context):
        give(owner_of(context, self.of_scene), self.key)
        return {"FINISHED"}


class RemoveField(bpy.types.Operator):
    """Back to what slosh takes by itself"""
    bl_idname = "slosh.remove_field"
    bl_label = "Remove"
    bl_options = {"UNDO", "INTERNAL"}
    key: bpy.props.StringProperty()
    of_scene: bpy.props.BoolProperty()

    def execute(self, context):
        owner = owner_of(context, self.of_scene)
        if self.key in owner:
            del owner[self.key]
        return {"FINISHED"}


class Choose(bpy.types.Operator):
    """Choose one"""
    bl_idname = "slosh.choose"
    bl_label = "Choose"
    bl_options = {"UNDO", "INTERNAL"}
    key: bpy.props.StringProperty()
    value: bpy.props.StringProperty()
    of_scene: bpy.props.BoolProperty()

    def execute(self, context):
        owner_of(context, self.of_scene)[self.key] = self.value
        return {"FINISHED"}


class Sixty(bpy.types.Operator):
    """Hands are exported a pose a frame: at 24 a second they hum"""
    bl_idname = "slosh.sixty"
    bl_label = "60 frames a second"
    bl_options = {"UNDO", "INTERNAL"}

    def execute(self, context):
        context.scene.render.fps, context.scene.render.fps_base = 60, 1.0
        return {"FINISHED"}


class Show(bpy.types.Operator):
    """Select this object"""
    bl_idname = "slosh.show"
    bl_label = "Show"
    bl_options = {"UNDO", "INTERNAL"}
    thing: bpy.props.StringProperty()

    def execute(self, context):
        found = context.scene.objects.get(self.thing)
        if found is None:
            return {"CANCELLED"}
        for each in context.selected_objects:
            each.select_set(False)
        found.select_set(True)
        context.view_layer.objects.active = found
        return {"FINISHED"}


def choices(context, field):
    """What a field may be, where it is one of a few."""
    if isinstance(field[2], list):
        return field[2]
    named = {"name": "grip", "body": "body"}.get(field[2]) if isinstance(field[2], str) else None
    return [thing.name for thing in context.scene.objects if thing.get("slosh") == named] if named else []


class FieldMenu:
    """The fields that are not there yet."""
    bl_label = "Add a field"
    of_scene = False

    def draw(self, context):
        owner = owner_of(context, self.of_scene)
        for key in fields_of(kind_of(owner)):
            if key not in owner:
                button = self.layout.operator(AddField.bl_idname, text=key)
                button.key, button.of_scene = key, self.of_scene


class ObjectFieldMenu(FieldMenu, bpy.types.Menu):
    bl_idname = "SLOSH_MT_object_fields"


class SceneFieldMenu(FieldMenu, bpy.types.Menu):
    bl_idname = "SLOSH_MT_scene_fields"
    of_scene = True
