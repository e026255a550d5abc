"""The files of a tree that the house's checks read: none of version control, builds and runs."""
import os

LEFT_OUT = {"build", "out", "shared"}
LEFT_OUT_BEGINNINGS = (".", "build-", "out-")


def files(root, endings, names=()):
    """Paths below root, by /, whose names end so or are one of these; in order."""
    for folder, folders, found in os.walk(root):
        folders[:] = sorted(f for f in folders if f not in LEFT_OUT and not f.startswith(LEFT_OUT_BEGINNINGS))
        for name in sorted(found):
            if name.endswith(endings) or name in names:
                yield os.path.relpath(os.path.join(folder, name), root).replace(os.sep, "/")
