"""A panel for slosh in Blender: say what each object is, check the scene, play it.

To install: Edit > Preferences > Add-ons > Install, choose slosh_blender.zip, tick "Import-Export: slosh", and name the
program there. The panel is in the 3D view's sidebar (N), tab "slosh". Everything that it sets is an ordinary custom
property, so a file made with it needs it no more. scenes/blender/README.md is a tutorial.
"""
import bpy

from . import objects, panel, run

bl_info = {
    "name": "slosh",
    "author": "the slosh authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "View3D > Sidebar > slosh",
    "description": "Say what touches and what flows, check the scene, play it",
    "category": "Import-Export",
}


CLASSES = (run.Finding, run.Check, run.Play, run.Stop, objects.AddField, objects.RemoveField, objects.Choose, objects.Sixty,
           objects.Show, objects.ObjectFieldMenu, objects.SceneFieldMenu, panel.RunPanel, panel.ObjectPanel, panel.ScenePanel,
           panel.Preferences)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Object.slosh_kind = bpy.props.EnumProperty(
        name="is", items=objects.kinds_for, get=objects.number_of_kind, set=objects.set_number_of_kind, description="What this is to slosh")
    # Not of the scene: what is registered there is exported with it, as custom properties.
    manager = bpy.types.WindowManager
    manager.slosh_findings = bpy.props.CollectionProperty(type=run.Finding, options={"SKIP_SAVE"})
    manager.slosh_result = bpy.props.StringProperty(options={"SKIP_SAVE"})
    manager.slosh_spacing = bpy.props.FloatProperty(name="spacing", unit="LENGTH", min=0.0, max=1.0, precision=4, description=(
        "Metres between particles of this play; 0: as fine as keeps real time"))
    manager.slosh_arguments = bpy.props.StringProperty(name="options", description=(
        "More of slosh play, as on the command line: --device spacemouse, --headless --out FOLDER"))


def unregister():
    for owner, name in ((bpy.types.Object, "slosh_kind"), (bpy.types.WindowManager, "slosh_findings"), (bpy.types.WindowManager, "slosh_result"),
                        (bpy.types.WindowManager, "slosh_spacing"), (bpy.types.WindowManager, "slosh_arguments")):
        delattr(owner, name)
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
