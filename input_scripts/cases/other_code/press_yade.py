# press_yade.py: Yade presses an electrode of `calendem pack` and releases it. A convenience for making truths of another
# code; nothing of Calendem runs it.
#   yade -n -x press_yade.py ELECTRODE OUT max_pressure_MPa=80 [cause=amount] [seed=1]
# ELECTRODE: folder of `calendem pack`. OUT: CSV of stage,gap_um,pressure_MPa with a last line of results.
# Units: um, us, pg, nN, kPa (as LIGGGHTS's `micro`).
import math
import random
import sys

from yade import utils

electrode, out = sys.argv[1], sys.argv[2]
given = dict(word.split("=") for word in sys.argv[3:])
target = 1e3 * float(given.pop("max_pressure_MPa"))
chance = random.Random(int(given.pop("seed", "1")))
SPEED, DAMPING = 4.0, 0.3
E_AM, E_CBD, STRENGTH, FRICTION = 140e6, 0.8e6, 3.5e5, 0.001
ROUGH_SPACING, ROUGH_RADIUS = 0.625, 0.8
LATTICE, DIAMETER, DENSITY = 1.28, 1.59, 4.63332608962

cause = {name: float(value) for name, value in given.items()}
known = {"friction", "soft_cbd", "pre_cracks", "weibull_strength", "body_scatter", "cbd_collapse", "rolling_resistance",
         "speed"}
if set(cause) - known:
    sys.exit(f"{sorted(set(cause) - known)[0]} is no cause; causes are {', '.join(sorted(known))}")
speed = SPEED * cause.get("speed", 1.0)
friction = math.atan(cause.get("friction", FRICTION))
e_cbd = E_CBD * cause.get("soft_cbd", 1.0)

# The electrode: primaries (type 1) with their bodies, and CBD (type 2).
atoms, reading, side = [], False, 0.0
with open(f"{electrode}/electrode.data") as file:
    for line in file:
        word = line.split()
        if line.startswith("Atoms"):
            reading = True
        elif "xhi" in line:
            side = float(word[1])
        elif reading and len(word) == 7:
            atoms.append((int(word[0]), int(word[1]), float(word[2]) / 2, float(word[3]), *map(float, word[4:7])))
with open(f"{electrode}/bodies.map") as file:
    body_of = {int(row.split()[0]): int(row.split()[1]) for row in file if not row.startswith("#")}
# Yade's broken pairs forget their distance at rest and would burst apart if they overlapped. So the primaries of a body
# touch: its spheres shrink and its lattice grows until they do, with its envelope as wide as before and its mass kept.
members = {}
for atom in atoms:
    if atom[1] == 1:
        members.setdefault(body_of[atom[0]], []).append(atom)
atoms = [atom for atom in atoms if atom[1] != 1]
for group in members.values():
    first = group[0][4:7]
    near = [[p - side * round((p - q) / side) if axis < 2 else p for axis, (p, q) in enumerate(zip(atom[4:7], first))]
            for atom in group]
    middle = [sum(c) / len(group) for c in zip(*near)]
    width = 2 * max(math.dist(p, middle) for p in near)
    scale = (width + DIAMETER) / (width + LATTICE)
    r = scale * LATTICE / 2
    for atom, place in zip(group, near):
        spot = [m + scale * (c - m) for c, m in zip(place, middle)]
        atoms.append((atom[0], 1, r, DENSITY * (DIAMETER / 2 / r) ** 3, *spot))
top = max(z + r for _, _, r, _, _, _, z in atoms)

O.periodic = True
O.cell.hSize = Matrix3(side, 0, 0, 0, side, 0, 0, 0, 4 * top)
am = O.materials.append(CohFrictMat(young=E_AM, poisson=0.3, density=4.63332608962, frictionAngle=friction, isCohesive=True,
                                    normalCohesion=1.0, shearCohesion=1.0, momentRotationLaw=True, etaRoll=-1, etaTwist=-1,
                                    alphaKr=0.5, alphaKtw=0.5, label="am"))
rolls = "rolling_resistance" in cause  # contacts with AM carry moments without limit, those of CBD up to the amount
cbd = O.materials.append(CohFrictMat(young=e_cbd, poisson=0.3, density=0.915, frictionAngle=friction, isCohesive=False,
                                     momentRotationLaw=rolls, alphaKr=0.5, alphaKtw=0.5,
                                     etaRoll=cause.get("rolling_resistance", -1), etaTwist=cause.get("rolling_resistance", -1)))
steel = O.materials.append(CohFrictMat(young=E_AM, poisson=0.3, density=8.0, frictionAngle=friction, isCohesive=False,
                                       momentRotationLaw=False))
LIFT = top  # the collector's surface is at this height: the cell is periodic in z too
id_of = {}
for tag, kind, r, density, x, y, z in atoms:
    id_of[tag] = O.bodies.append(utils.sphere((x, y, z + LIFT), r, material=am if kind == 1 else cbd))
    O.bodies[id_of[tag]].state.mass = density * 4 / 3 * math.pi * r**3
    O.bodies[id_of[tag]].state.inertia = Vector3(1, 1, 1) * 0.4 * density * 4 / 3 * math.pi * r**5
body_by_id = {id_of[tag]: body for tag, body in body_of.items()}
cbd_ids = [id_of[a[0]] for a in atoms if a[1] == 2]


def layer(z):
    n = round(side / ROUGH_SPACING)
    return [O.bodies.append(utils.sphere(((i + 0.5) * side / n, (j + 0.5) * side / n, z), ROUGH_RADIUS, material=steel, fixed=True))
            for i in range(n) for j in range(n)]


layer(LIFT - ROUGH_RADIUS)
platen = layer(LIFT + top + ROUGH_RADIUS + 0.02)
head = platen[0]
gap = lambda: O.bodies[head].state.pos[2] - ROUGH_RADIUS - LIFT

ip = Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionNow=False, setCohesionOnNewContacts=False)
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.02, label="boxes")], verletDist=0.15),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom6D(interactionDetectionFactor=1.02, label="contacts")], [ip],
                    [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(always_use_moment_law=rolls, useIncrementalForm=True)]),
    NewtonIntegrator(damping=DAMPING, gravity=(0, 0, 0)),
]
mass = DENSITY * 4 / 3 * math.pi * (DIAMETER / 2)**3
O.dt = 0.0
O.step()
boxes.aabbEnlargeFactor = contacts.interactionDetectionFactor = 1.0
# Bonds: touching pairs of one body, at rest where they are; later contacts are not cohesive.
body_factor = {}
bonds = []
for i in O.interactions:
    if i.id1 not in body_by_id or i.id2 not in body_by_id:
        if i.id1 in id_of.values() and i.id2 in id_of.values():
            i.phys.unp = max(0.0, i.geom.penetrationDepth)  # the packing is at rest
        continue
    if body_by_id[i.id1] != body_by_id[i.id2]:
        i.phys.unp = max(0.0, i.geom.penetrationDepth)
        continue
    if i.geom.penetrationDepth < -1e-3:
        continue
    i.phys.unp = i.geom.penetrationDepth
    bonds.append(i)
for i in bonds:
    factor = 1.0
    if "weibull_strength" in cause:
        factor *= chance.weibullvariate(1 / math.gamma(1 + 1 / cause["weibull_strength"]), cause["weibull_strength"])
    if "body_scatter" in cause:
        body = body_by_id[i.id1]
        body_factor.setdefault(body, math.exp(chance.gauss(0, cause["body_scatter"])))
        factor *= body_factor[body]
    if chance.random() < cause.get("pre_cracks", 0.0):
        continue
    i.phys.cohesionBroken = False
    i.phys.fragile = True
    i.phys.normalAdhesion = factor * STRENGTH * 0.64**2 * math.pi
    i.phys.shearAdhesion = factor * STRENGTH * 0.64**2 * math.pi
pairs = [(i.id1, i.id2) for i in bonds]
O.dt = 0.45 * math.sqrt(mass / (E_AM * 0.795))


def pressure():
    return sum(O.forces.f(k)[2] for k in platen) / side**2


def collapse():
    """CBD spheres whose pores close: the radius shrinks where the contact pressure exceeds the yield pressure."""
    least = 0.5 ** (1 / 3) * 0.658
    load = {}
    for i in O.interactions:
        f = i.phys.normalForce.norm()
        load[i.id1] = load.get(i.id1, 0) + f
        load[i.id2] = load.get(i.id2, 0) + f
    for k in cbd_ids:
        r = O.bodies[k].shape.radius
        if r > least and load.get(k, 0) / (4 * math.pi * r * r) > 1e3 * cause["cbd_collapse"]:
            r = max(least, 0.995 * r)
            O.bodies[k].shape.radius = r
            for i in O.bodies[k].intrs():
                if i.isReal:
                    if i.id1 == k:
                        i.geom.refR1 = r
                    else:
                        i.geom.refR2 = r


def move(velocity):
    for k in platen:
        O.bodies[k].state.vel = (0, 0, velocity)


rows, every = [], 40
window = 0.05 / speed


def block(stage):
    """A row of the curve: means of gap and pressure over 0.05 um of travel."""
    n = max(1, round(window / (O.dt * every)))
    p = g = 0.0
    for _ in range(n):
        O.run(every, True)
        p += pressure()
        g += gap()
    if "cbd_collapse" in cause:
        collapse()
    rows.append((stage, g / n, p / n))
    return p / n


move(-speed)
while True:
    reached = block("loading")
    if reached >= target:
        break
    if gap() < 2:
        sys.exit(f"{electrode}: {target / 1e3} MPa was not reached above a gap of 2 um")
most = rows[-1]
move(speed)
previous = most
while True:
    p = block("unloading")
    if p < 0.01 * most[2]:
        break
    previous = rows[-1]
share = (previous[2] - 0.01 * most[2]) / max(1e-12, previous[2] - rows[-1][2])
after = previous[1] + share * (rows[-1][1] - previous[1])
whole = 0
for a, b in pairs:
    if O.interactions.has(a, b) and O.interactions[a, b].isReal:
        whole += not O.interactions[a, b].phys.cohesionBroken
with open(out, "w") as file:
    file.write("stage,gap_um,pressure_MPa\n")
    for stage, g, p in rows:
        file.write(f"{stage},{g:.4f},{p / 1e3:.4f}\n")
    file.write(f"# top {top:.4f} at_max {most[1]:.4f} after {after:.4f} broken {1 - whole / len(pairs):.4f} steps {O.iter}\n")
