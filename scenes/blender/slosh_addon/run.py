"""Export, and what calls slosh: Check, Play, Stop."""
import json
import os
import shlex
import shutil
import subprocess
import tempfile

import bpy


def preferences():
    here = bpy.context.preferences.addons.get(__package__)
    return here.preferences if here else None


def find_program():
    """What the preferences name, $SLOSH, slosh on the path; None where there is none."""
    chosen = preferences()
    for place in (chosen.program if chosen else "", os.environ.get("SLOSH", ""), shutil.which("slosh") or ""):
        place = os.path.abspath(bpy.path.abspath(place)) if place else ""
        if place and os.path.isfile(place) and os.access(place, os.X_OK):
            return place
    return None


def export(path):
    """The open scene as slosh reads it: custom properties, cameras, modifiers applied, y up, animation."""
    bpy.ops.export_scene.gltf(filepath=path, export_format="GLB", export_extras=True, export_cameras=True,
                              export_apply=True, export_yup=True, export_animations=True)


def export_path():
    """Beside the .blend file where it was saved, else in a folder of this Blender's own."""
    if bpy.data.filepath:
        return os.path.splitext(bpy.data.filepath)[0] + ".glb"
    return os.path.join(bpy.app.tempdir or tempfile.gettempdir(), "untitled.glb")


class Finding(bpy.types.PropertyGroup):
    kind: bpy.props.StringProperty()
    thing: bpy.props.StringProperty()
    text: bpy.props.StringProperty()
    mend: bpy.props.StringProperty()


class Running:
    """The program that was started, and where what it says goes. One at a time."""
    child = None
    log = ""
    words = ""

    @classmethod
    def start(cls, arguments):
        cls.log = os.path.join(bpy.app.tempdir or tempfile.gettempdir(), "slosh.log")
        with open(cls.log, "wb") as log:
            cls.child = subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE if "--json" in arguments else log,
                                         stderr=log, cwd=os.path.dirname(arguments[2]))

    @classmethod
    def last_lines(cls, count=4):
        with open(cls.log, encoding="utf-8", errors="replace") as log:
            return [line for line in log.read().replace("\r", "\n").split("\n") if line.strip()][-count:]


def show_check(manager, said):
    """What `slosh check --json` found, into the panel's list."""
    manager.slosh_findings.clear()
    for kind, list_of in (("error", said["errors"]), ("warning", said["warnings"])):
        for each in list_of:
            finding = manager.slosh_findings.add()
            finding.kind, finding.thing = kind, each["object"]
            _, named, field = each["where"].rpartition("extras.")
            finding.text, finding.mend = (field + " " if named else "") + each["what"], each["mend"]
    if not said["ok"]:
        return f"{len(said['errors'])} to mend before it plays"
    about = said["scene"]
    return (f"It plays: {about['fluid_litres']:.2f} litres, {about['fluid_particles']} particles at "
            f"{1000 * about['spacing_m']:.1f} mm, grips: {about['grips']}")


class Started(bpy.types.Operator):
    """Shared by Check and Play: export, start slosh, wait without holding Blender up."""
    bl_options = {"INTERNAL"}
    timer = None

    def arguments(self, path):
        raise NotImplementedError

    def finish(self, manager, code, out):
        raise NotImplementedError

    def execute(self, context):
        program = find_program()
        if program is None:
            self.report({"ERROR"}, "slosh was not found: name its program in Preferences > Add-ons > slosh")
            return {"CANCELLED"}
        if Running.child is not None:
            self.report({"ERROR"}, "slosh is running already: stop it first")
            return {"CANCELLED"}
        if context.object is not None and context.object.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")  # what is being edited would not be exported
        path = export_path()
        try:
            export(path)
            Running.start([program, *self.arguments(path)])
        except (OSError, RuntimeError) as error:
            self.report({"ERROR"}, f"{path}: {error}")
            return {"CANCELLED"}
        Running.words = self.bl_label + " …"
        if bpy.app.background:  # nobody to keep waiting
            out = Running.child.communicate()[0]
            return self.ended(context, out)
        self.timer = context.window_manager.event_timer_add(0.2, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type != "TIMER" or Running.child.poll() is None:
            return {"PASS_THROUGH"}
        context.window_manager.event_timer_remove(self.timer)
        out = Running.child.stdout.read() if Running.child.stdout else b""
        return self.ended(context, out)

    def ended(self, context, out):
        code = Running.child.returncode
        Running.child, Running.words = None, ""
        context.window_manager.slosh_result = self.finish(context.window_manager, code, out)
        self.report({"INFO"}, context.window_manager.slosh_result)
        for area in context.screen.areas if context.screen else ():
            area.tag_redraw()
        return {"FINISHED"}


class Check(Started):
    """Export the scene and let slosh say everything that is wrong with it"""
    bl_idname = "slosh.check"
    bl_label = "Check"

    def arguments(self, path):
        return ["check", path, "--json"]

    def finish(self, manager, code, out):
        try:
            return show_check(manager, json.loads(out))
        except (ValueError, KeyError):
            return "; ".join(Running.last_lines()) or f"slosh ended with exit code {code}"


class Play(Started):
    """Export the scene and play it in slosh's window"""
    bl_idname = "slosh.play"
    bl_label = "Play"

    def arguments(self, path):
        manager = bpy.context.window_manager
        spacing, more = manager.slosh_spacing, shlex.split(manager.slosh_arguments)
        return ["play", path, *(["--spacing", f"{spacing:g}"] if spacing > 0 else []), *more]

    def finish(self, manager, code, out):
        last = "; ".join(Running.last_lines())
        return f"Played. {last}" if code in (0, 130, 143, -15) else f"slosh ended with exit code {code}: {last}"


class Stop(bpy.types.Operator):
    """End what slosh is doing, in order"""
    bl_idname = "slosh.stop"
    bl_label = "Stop"

    @classmethod
    def poll(cls, _context):
        return Running.child is not None

    def execute(self, _context):
        Running.child.terminate()
        return {"FINISHED"}
