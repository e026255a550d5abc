# The add-on's fields are those of the tables in scenes/FIELDS.md, with their ranges. No Blender in here.
# Usage: fields_test.py SOURCE
import re
import sys
from pathlib import Path

source = Path(sys.argv[1])
sys.path.insert(0, str(source / "scenes" / "blender" / "slosh_addon"))
sys.dont_write_bytecode = True
from fields import FIELDS, KINDS  # noqa: E402

text = (source / "scenes" / "FIELDS.md").read_text()
wrong = []


def section(title):
    return re.split(r"^###? ", text.split(f"### {title}\n")[1], flags=re.M)[0]


def table(title):
    """Fields of a section, each with the numbers of its range."""
    fields = {}
    for row in re.findall(r"^\| (`[a-z_0-9]+`(?:, `[a-z_0-9]+`)*) \|(.*)\|$", section(title), flags=re.M):
        cells = row[1].split(" | ")
        for name in re.findall(r"`([a-z_0-9]+)`", row[0]):
            fields[name] = cells[1] if len(cells) > 1 else ""
    return fields


def number(word):
    word = word.replace("10⁹", "1e9").replace("10⁷", "1e7").replace("10⁶", "1e6").replace("10⁵", "1e5").replace("10⁴", "1e4").replace("10³", "1e3")
    return float(word.replace("10⁻⁴", "1e-4"))


def most_in(words):
    """What a range's cell says is the most; None where it says none."""
    found = re.search(r"(?:–|±|≤ )(10[⁻⁰-⁹⁴-⁹³]+|[0-9.]+)", words)
    return number(found.group(1)) if found else None


for kind, title in (("body", "body"), ("fluid", "fluid"), ("grip", "grip"), ("joint", "joint"), ("scene", "the scene's own properties")):
    said, known = table(title), {field[0]: field for field in FIELDS[kind]}
    if kind == "scene":
        said.pop("fluids")  # a table of tables: by hand
    if len(said) < 4:
        wrong.append(f"the table of {kind} was not found")
    for name in sorted(said.keys() ^ known.keys()):
        wrong.append(f"{kind}.{name} is only in {'scenes/FIELDS.md' if name in said else 'the add-on'}")
    for name in sorted(said.keys() & known.keys()):
        most = most_in(said[name])
        if most is not None and known[name][4] is not None and most != known[name][4]:
            wrong.append(f"{kind}.{name}: at most {most:g} by scenes/FIELDS.md, {known[name][4]:g} by the add-on")
kinds = set(re.findall(r"^\| `([a-z]+)`[^|]*\| (?:a closed mesh|an empty|a mesh)", text, flags=re.M))
if kinds != {name for name, _, _ in KINDS}:
    wrong.append(f"kinds: {kinds ^ {name for name, _, _ in KINDS}}")
for sentence in wrong:
    print(sentence)
sys.exit(bool(wrong))
