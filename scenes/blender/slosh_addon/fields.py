"""What an object may be to slosh, and the fields of each kind: unit, first value, range, words. No Blender in here.

The ranges are slosh's own (scenes/FIELDS.md has the tables); a test holds both against each other.
"""

# What an object may be: name, what it becomes, the types of object that can be it.
KINDS = [
    ("body", "A rigid body, fixed, carried or animated: a closed mesh", ("MESH",)),
    ("fluid", "A volume that starts full of fluid: a closed mesh", ("MESH",)),
    ("grip", "Where a device takes hold: an empty, child of a body or probe", ("EMPTY",)),
    ("hand", "The scripted handle of one grip: an animated empty", ("EMPTY",)),
    ("probe", "A point that feels fluid: an empty, or a mesh for its looks", ("EMPTY", "MESH")),
    ("joint", "A hinge, a slider or a rigid one: an empty, child of one of its two bodies", ("EMPTY",)),
    ("gauge", "A point at which level and pressure are read: an empty", ("EMPTY",)),
    ("region", "A space in which the fluid is weighed: a closed mesh", ("MESH",)),
    ("picture", "Only looked at: a mesh", ("MESH",)),
]

# Fields: key, unit, first value, least, most, what it is. A list of words is a choice, a tuple a vector; "name" names a
# grip, "body" a body. Least and most are slosh's own, None where there is none; a 0 that slosh refuses is 1e-6 here.
COMMON = [
    ("particle_density_kg_m3", "kg/m3", 0.0, 0.0, 1e6, "Of its wall particles; 0: the plan chooses"),
    ("friction", "", 0.4, 0.0, 10.0, "Against other bodies"),
    ("restitution", "", 0.0, 0.0, 1.0, "0: no bounce, 1: all of it"),
    ("measured", "", False, None, None, "Its pose and the fluid's wrench are written"),
]
MOVES = [
    ("velocity_m_s", "m/s", (0.0, 0.0, 0.0), -1000.0, 1000.0, "At first; axes y up: (x, z, -y) of Blender's"),
]
FIELDS = {
    "body": [
        ("motion", "", ["fixed", "free", "driven"], None, None,
         "fixed: it stands; free: it falls, or is carried; driven: it goes by its keys"),
        ("starts_away", "", False, None, None, "Not there before a step of the task, or a command, brings it"),
        ("repeat", "", False, None, None, "A driven body's keys begin again after the last"),
        ("pieces", "", 2.0, 2.0, 16.0, "By cuts a free convex body may become so many"),
        ("cut_n_m", "N/m", 100.0, 0.0, 1e6, "What a blade needs for each metre of its edge inside it"),
        ("blade", "", False, None, None, "It cuts with its edge, along x at its lowest y, towards -y"),
        ("mass_kg", "kg", 0.5, 1e-6, None, "Of a free body: this or its density"),
        ("density_kg_m3", "kg/m3", 1000.0, 1e-6, 1e6, "Of a free body, in place of its mass"),
        ("viscosity_pa_s", "Pa s", 1.0, 0.0, 1e7, "Of its wall; without it the fluid's own: the fluid sticks"),
        ("slip", "", False, None, None, "The fluid slides along it"),
        ("center_of_mass_m", "m", (0.0, 0.0, 0.0), -1e4, 1e4, "In the mesh's frame, y up; without it the mesh's"),
        ("inertia_kg_m2", "kg m2", (0.01, 0.01, 0.01, 0.0, 0.0, 0.0), -1e9, 1e9, "xx, yy, zz, xy, xz, yz; without it the mesh's"),
        *COMMON, *MOVES,
        ("temperature_c", "C", 20.0, -273.15, 5000.0, "That all of it keeps; without it no heat passes it"),
        ("angular_velocity_rad_s", "rad/s", (0.0, 0.0, 0.0), -1000.0, 1000.0, "At first; axes y up: (x, z, -y) of Blender's"),
    ],
    "fluid": [
        ("fluid", "", "water", None, None, "Its name: volumes of one fluid share it"),
        ("density_kg_m3", "kg/m3", 1000.0, 1e-6, 1e5, ""),
        ("viscosity_pa_s", "Pa s", 0.001, 0.0, 1e7, "Water 0.001, oil 0.1, honey 5"),
        ("color", "", (0.10, 0.35, 0.55), 0.0, 1.0, "Linear red, green, blue"),
        ("extinction_per_m", "1/m", (12.0, 4.0, 2.5), 0.0, 1e5, "Of red, green, blue: light is down to 37 % after 1/this"),
        ("scattering", "", 0.2, 0.0, 1.0, "0: juice; 1: milk"),
        ("gloss", "", 1.0, 0.0, 1.0, "Share of a clean surface's reflection"),
        ("roughness", "", 0.05, 0.0, 1.0, "Of the surface; 0: a mirror"),
        ("refraction", "", 1.33, 1.0, 3.0, "Refractive index: water 1.33, oil 1.47"),
        ("temperature_c", "C", 20.0, -273.15, 5000.0, "At the start"),
        ("heat_capacity_j_kg_k", "J/(kg K)", 4180.0, 1.0, 1e5, "Water 4180, butter 2200"),
        ("conductivity_w_m_k", "W/(m K)", 0.6, 0.0, 1e4, "Water 0.6, butter 0.2"),
        ("viscosity_at_c", "C, Pa s", (20.0, 1.5, 60.0, 0.2), -273.15, 1e7, "Pairs, in place of viscosity_pa_s"),
        ("sets_above_c", "C", 75.0, -273.15, 5000.0, "It sets where it is as warm"),
        ("sets_below_c", "C", 15.0, -273.15, 5000.0, "It sets where it is as cold"),
        ("sets_in_s", "s", 5.0, 1e-6, 86400.0, "How long it takes to set there"),
        ("set_viscosity_pa_s", "Pa s", 100.0, 1e-6, 1e7, "When it has set"),
        ("set_modulus_pa", "Pa", 2e4, 1e-6, 1e9, "Young's, when it has set; without it it is only thicker"),
        ("tears_at", "", 0.5, 1e-6, 10.0, "Strain above which it is torn"),
        ("melts_above_c", "C", 35.0, -273.15, 5000.0, "It melts where it is as warm"),
        ("melts_in_s", "s", 5.0, 1e-6, 86400.0, "How long it takes to melt there"),
        ("starts_set", "", False, None, None, "It has set at the start"),
        ("starts_away", "", False, None, None, "Empty before a step of the task, or a command, fills it"),
        ("fillings", "", 2.0, 1.0, 1000.0, "So many times it can be filled, the start counted"),
        *MOVES,
    ],
    "grip": [
        ("stiffness_n_m", "N/m", 1000.0, 0.0, 1e6, "Of the spring between hand and thing"),
        ("damping_n_s_m", "N s/m", 20.0, 0.0, 1e4, ""),
        ("rotational_stiffness_nm_rad", "N m/rad", 10.0, 0.0, 1e4, ""),
        ("rotational_damping_nm_s_rad", "N m s/rad", 0.2, 0.0, 1e3, ""),
        ("device", "", 0, 0, 1000, "Order of the devices, each number once"),
    ],
    "hand": [("grip", "", "name", None, None, "The grip that it holds; there at the first frame")],
    "joint": [
        ("kind", "", ["hinge", "slider", "fixed"], None, None, "It turns about or slides along the empty's z, or holds"),
        ("to", "", "body", None, None, "The other body's name; without it the world"),
        ("min_deg", "degrees", 0.0, -36000.0, 0.0, "A hinge's stop, from where it is in the file"),
        ("max_deg", "degrees", 0.0, 0.0, 36000.0, "A hinge's other stop"),
        ("min_m", "m", 0.0, -1000.0, 0.0, "A slider's stop, from where it is in the file"),
        ("max_m", "m", 0.0, 0.0, 1000.0, "A slider's other stop"),
        ("damping_nm_s_rad", "N m s/rad", 0.0, 0.0, 1e6, "Of a hinge"),
        ("damping_n_s_m", "N s/m", 0.0, 0.0, 1e6, "Of a slider"),
        ("motor_nm", "N m", 1.0, 0.0, 1e6, "The most that a hinge's motor has"),
        ("motor_rad_s", "rad/s", 0.0, -1000.0, 1000.0, "That a hinge's motor goes for; 0: a brake"),
        ("motor_n", "N", 1.0, 0.0, 1e6, "The most that a slider's motor has"),
        ("motor_m_s", "m/s", 0.0, -1000.0, 1000.0, "That a slider's motor goes for; 0: a brake"),
        ("breaks_n", "N", 10.0, 1e-6, 1e6, "It lets go above this force; without it never"),
        ("breaks_nm", "N m", 1.0, 1e-6, 1e6, "It lets go above this torque; without it never"),
        ("starts_apart", "", False, None, None, "A fixed one is open at first"),
        ("joins_m", "m", 0.002, 1e-6, 10.0, "A fixed one that is open closes when its frames come so near"),
        ("joins_deg", "degrees", 10.0, 1e-6, 180.0, "And are turned by no more"),
        ("meets", "", "", None, None, "Name of the empty on the other body that it closes with"),
    ],
    "probe": [
        ("mass_kg", "kg", 0.05, 1e-6, None, ""),
        ("viscosity_pa_s", "Pa s", 0.0, 0.0, 1e7, "0: the fluid's"),
        *COMMON,
    ],
    "gauge": [],
    "region": [],
    "picture": [],
    "scene": [
        ("title", "", "A scene", None, None, "One line"),
        ("duration_s", "s", 10.0, 1e-3, 86400.0, "How long the scripted hands are played"),
        ("still_s", "s", 0.0, 0.0, 86400.0, "When final.png is taken; 0: at the end of the film"),
        ("task", "", "", None, None, "Steps of a guided task, as JSON: scenes/TASKS.md"),
        ("settle_s", "s", 1.0, 0.0, 60.0, "At rest before the run begins; 0: as it stands here"),
        ("spacing_m", "m", 0.01, 0.0, 1.0, "Between particles; 0, or without it: as fine as keeps real time"),
        ("spacing_min_m", "m", 0.004, 1e-4, 1.0, "The finest that is chosen"),
        ("spacing_max_m", "m", 0.02, 1e-4, 1.0, "The coarsest"),
        ("gravity_m_s2", "m/s2", (0.0, -9.81, 0.0), -1000.0, 1000.0, "Axes y up: down is (0, -9.81, 0)"),
        ("domain_min_m", "m", (-1.0, -0.5, -1.0), None, None, "What leaves it is gone; axes y up"),
        ("domain_max_m", "m", (1.0, 1.5, 1.0), None, None, "Its other corner"),
        ("model", "", ["corrected", "incompressible", "paper"], None, None, "Of the particles; sim/pressure/README.md compares them"),
        ("support_ratio", "", 2.0, 1.5, 2.6, "Support radius over spacing"),
        ("stiffness_m2_s2", "m2/s2", 0.0, 0.0, None, "Eq 7's k; 0: the plan chooses"),
        ("tension", "", 0.0, 0.0, 1.0, "Share of Eq 7's negative pressure kept"),
        ("light_direction", "", (-0.4, -1.0, -0.35), -1000.0, 1000.0, "The way light travels; axes y up"),
    ],
}
# Without these nothing plays: they are there as soon as the object is of that kind.
FIRST = {"body": ("motion",), "fluid": ("fluid", "viscosity_pa_s"), "hand": ("grip",), "joint": ("kind",)}
LEAST_RATE = 55  # frames a second: hands keyed more coarsely hum


def fields_of(kind):
    return {field[0]: field for field in FIELDS.get(kind, [])}
