# SPDX-License-Identifier: GPL-2.0-or-later
"""The paper's Figures 3 and 5 of a run, in ParaView.

  pvpython input_scripts/paraview/figures.py RUN [-o FOLDER] [--body N] [--no-pictures]

RUN: folder made by `calendem run` or `collect` (curve.csv, breaks.csv, bodies.csv, vtk/*.pvd).
Writes into FOLDER (default RUN/figures):
  figures.pvsm                 state with both figures: ParaView, File > Load State
  figure3_electrode_K.png      bodies by colour, carbon-binder domain dark, at the K-th pressure
  figure3_bonds_K.png          intact bonds: blue those that break in this run, purple the others
  figure5_place.png            body N in the electrode (default: the one with most broken bonds)
  figure5_shape_K.png, figure5_bonds_K.png
Pressures: the frames in compression nearest to 0, 9.2, 20.1, 50.9, 146.8 MPa (Xu et al., Figure 3), as far as
the run went. Bonds through periodic faces are left out. Units: um, us, MPa.
Pictures need a display or an off-screen build of ParaView (without: --no-pictures, or `xvfb-run pvpython ...`).
Exit status: 0 done, 1 usage, 2 the run cannot be read.
"""
import argparse
import csv
import json
import os
import sys

from paraview import simple

PRESSURES = [0.0, 9.2, 20.1, 50.9, 146.8]  # MPa
REACHED = 0.97  # of a pressure: near enough to show
PURPLE, BLUE, DARK, ORANGE = [0.59, 0.31, 0.63], [0.0, 0.39, 0.78], [0.3, 0.3, 0.3], [0.9, 0.47, 0.08]
BOND_RADIUS = 0.17  # um, as drawn

# Runs inside ParaView: 0 intact to the end, 1 will break, 2 broken, 3 through a periodic face.
FATE = """
import csv
import numpy
with open({breaks!r}, newline="") as stream:
    broken = {{frozenset((int(r["tag_i"]), int(r["tag_j"]))) for r in csv.DictReader(stream)}}
bonds = inputs[0]
cells, points = bonds.CellData, bonds.Points
tags = zip(numpy.rint(cells["tag_i"]).astype(int), numpy.rint(cells["tag_j"]).astype(int))
fate = numpy.array([1 if frozenset(pair) in broken else 0 for pair in tags])
fate[numpy.asarray(cells["state"]) < 0.5] = 2
ends = numpy.asarray(points).reshape(-1, 2, 3)
fate[numpy.linalg.norm(ends[:, 0] - ends[:, 1], axis=1) > {longest}] = 3
output.CellData.append(fate, "fate")
"""


# Runs inside ParaView: the pieces of a body that the periodic faces cut, around its centre.
WHOLE = """
import numpy
x = numpy.array(inputs[0].Points)
for k, side in enumerate({period}):
    angle = 2.0 * numpy.pi * x[:, k] / side
    centre = side / (2.0 * numpy.pi) * numpy.arctan2(numpy.sin(angle).sum(), numpy.cos(angle).sum())
    x[:, k] -= side * numpy.round((x[:, k] - centre) / side)
output.Points = x
"""


def rows(run, name):
    with open(os.path.join(run, name), newline="") as stream:
        return [row for row in csv.DictReader(line for line in stream if not line.startswith("#"))]


def stages(curve, times):
    """(wanted pressure, frame's time, its pressure), a frame once: for the pressure it is nearest to."""
    def pressure(time):
        return min(((abs(float(r["time_us"]) - time), float(r["pressure_MPa"])) for r in curve))[1]

    top = max(curve, key=lambda r: float(r["pressure_MPa"]))
    frames = [(t, pressure(t)) for t in times if t <= float(top["time_us"]) + 1e-9]
    found = {}
    for wanted in PRESSURES:
        if float(top["pressure_MPa"]) < REACHED * wanted:
            continue
        time, p = frames[0] if wanted == 0 else min(frames, key=lambda f: abs(f[1] - wanted))
        if time not in found or abs(p - wanted) < abs(found[time][1] - found[time][0]):
            found[time] = (wanted, p)
    return [(wanted, time, p) for time, (wanted, p) in sorted(found.items())]


def series(run, name):
    file = os.path.abspath(os.path.join(run, "vtk", name + ".pvd"))
    if not os.path.exists(file):
        raise OSError(file + " is not there: run the case again, or calendem collect " + run)
    reader = simple.PVDReader(registrationName=name, FileName=file)
    reader.UpdatePipelineInformation()
    return reader


def part_of(source, association, name, low, high):
    """Points or cells whose `name` lies between `low` and `high`."""
    part = simple.Threshold(registrationName=f"{name} {low:g} to {high:g}", Input=source)
    part.Scalars = [association, name]
    part.LowerThreshold, part.UpperThreshold = low, high
    part.ThresholdMethod = "Between"
    return part


def whole(run, source):
    """One body in one piece, if electrode.json gives the cell."""
    file = os.path.join(run, "electrode.json")
    period = json.load(open(file, encoding="utf-8")).get("cell_um") if os.path.exists(file) else None
    if not period:
        return source
    out = simple.ProgrammableFilter(registrationName="in one piece", Input=source)
    out.CopyArrays = 1
    out.Script = WHOLE.format(period=list(period))
    return out


def spheres(source):
    glyph = simple.Glyph(registrationName="spheres", Input=source, GlyphType="Sphere")
    glyph.ScaleArray = ["POINTS", "radius"]
    glyph.ScaleFactor = 2.0  # a glyph is 1 wide
    glyph.GlyphMode = "All Points"
    glyph.GlyphType.ThetaResolution = glyph.GlyphType.PhiResolution = 12
    return glyph


def rods(source):
    surface = simple.ExtractSurface(registrationName="lines", Input=source)
    tube = simple.Tube(registrationName="rods", Input=surface)
    tube.Radius, tube.NumberofSides = BOND_RADIUS, 8
    return tube


def bonds_by_fate(run, reader, longest):
    fate = simple.ProgrammableFilter(registrationName="fate of bonds", Input=reader)
    fate.CopyArrays = 1
    fate.Script = FATE.format(breaks=os.path.abspath(os.path.join(run, "breaks.csv")), longest=longest)
    return part_of(fate, "CELLS", "fate", 0, 0), part_of(fate, "CELLS", "fate", 1, 1)


def view_of(name):
    one_body = name in ("figure5_shape", "figure5_bonds")
    view = simple.CreateView("RenderView", registrationName=name)
    view.ViewSize = [500, 500] if one_body else [500, 1000]
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesVisibility = 0
    view.CameraParallelProjection = 1
    return view


def show(source, view, colour=None, opacity=1.0):
    """One colour, or without it one for each body."""
    shown = simple.Show(source, view)
    shown.Opacity = opacity
    if colour:
        shown.ColorArrayName = ["POINTS", ""]
        shown.AmbientColor = shown.DiffuseColor = colour
    else:
        simple.ColorBy(shown, ("POINTS", "body"))
        shown.LookupTable = body_colours()
    return shown


def body_colours():
    table = simple.GetColorTransferFunction("body")
    table.AutomaticRescaleRangeMode = "Never"
    if not table.ApplyPreset("Rainbow Uniform", True):
        raise RuntimeError("this ParaView has no colour map 'Rainbow Uniform'")
    return table


def look_at(view, bounds):
    """From the side and a little above, whole: as the report's camera."""
    centre = [0.5 * (bounds[2 * k] + bounds[2 * k + 1]) for k in range(3)]
    size = max(bounds[2 * k + 1] - bounds[2 * k] for k in range(3))
    view.CameraFocalPoint = centre
    view.CameraPosition = [centre[0] + 1.3 * size, centre[1] - 2.4 * size, centre[2] + 0.7 * size]
    view.CameraViewUp = [0, 0, 1]
    view.CameraParallelScale = (0.56 if bounds[5] - bounds[4] == size else 0.75) * size


def build(run, body):
    """The four views: name -> (view, whether it follows one body)."""
    particles, bonds, platen = (series(run, n) for n in ("particles", "bonds", "platen"))
    particles.UpdatePipeline(particles.TimestepValues[0])
    bounds = particles.GetDataInformation().GetBounds()
    longest = 0.5 * min(bounds[1] - bounds[0], bounds[3] - bounds[2])
    stay, will_break = bonds_by_fate(run, bonds, longest)
    views = {name: view_of(name) for name in ("figure3_electrode", "figure3_bonds", "figure5_place",
                                              "figure5_shape", "figure5_bonds")}
    secondary = part_of(particles, "POINTS", "body", 1, 1e9)
    binder = part_of(particles, "POINTS", "body", 0, 0)
    studied = part_of(particles, "POINTS", "body", body, body)
    one = spheres(whole(run, studied))
    show(spheres(secondary), views["figure3_electrode"])
    show(spheres(binder), views["figure3_electrode"], DARK)
    show(rods(stay), views["figure3_bonds"], PURPLE)
    show(rods(will_break), views["figure3_bonds"], BLUE)
    show(spheres(secondary), views["figure5_place"], DARK, 0.06)
    show(spheres(studied), views["figure5_place"], ORANGE)
    show(one, views["figure5_shape"], ORANGE)
    for part, colour in ((stay, PURPLE), (will_break, BLUE)):
        show(rods(whole(run, part_of(part, "CELLS", "body", body, body))), views["figure5_bonds"], colour)
    for name in ("figure3_electrode", "figure3_bonds", "figure5_place"):
        show(platen, views[name], [0.5, 0.58, 0.66], 0.3)
        look_at(views[name], bounds)
    return views, one, list(particles.TimestepValues), (stay, will_break)


def counts(parts, time):
    out = []
    for part in parts:
        part.UpdatePipeline(time)
        out.append(part.GetDataInformation().GetNumberOfCells())
    return out


def draw(folder, views, one, found):
    """Pictures of every stage; the views of one body move with it."""
    for number, (_, time, _) in enumerate(found):
        one.UpdatePipeline(time)
        for name in ("figure5_shape", "figure5_bonds"):
            look_at(views[name], one.GetDataInformation().GetBounds())
        for name, view in views.items():
            if name == "figure5_place" and number > 0:
                continue
            view.ViewTime = time
            end = "" if name == "figure5_place" else f"_{number}"
            simple.SaveScreenshot(os.path.join(folder, name + end + ".png"), view)


def most_broken(run):
    best = max(rows(run, "bodies.csv"), key=lambda r: int(r["broken"]), default=None)
    if best is None:
        raise ValueError("bodies.csv has no rows: calendem collect " + run)
    return int(best["body"])


def main():
    words = argparse.ArgumentParser(description=__doc__,
                                    formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("run")
    words.add_argument("-o", "--output")
    words.add_argument("--body", type=int)
    words.add_argument("--no-pictures", action="store_true")
    try:
        given = words.parse_args()
    except SystemExit as end:
        return 1 if end.code else 0
    folder = given.output or os.path.join(given.run, "figures")
    try:
        body = given.body or most_broken(given.run)
        views, one, times, parts = build(given.run, body)
        found = stages(rows(given.run, "curve.csv"), times)
    except (OSError, KeyError, ValueError) as error:
        print(f"figures: {given.run}: cannot be read: {error}", file=sys.stderr)
        return 2
    os.makedirs(folder, exist_ok=True)
    one.UpdatePipeline(times[0])
    for name in ("figure5_shape", "figure5_bonds"):
        look_at(views[name], one.GetDataInformation().GetBounds())
    for wanted, time, pressure in found:
        stay, will_break = counts(parts, time)
        print(f"figures: paper {wanted:g} MPa, frame at {time:g} us, {pressure:.1f} MPa: "
              f"{stay} bonds stay, {will_break} will break")
    simple.SaveState(os.path.join(folder, "figures.pvsm"))
    if not given.no_pictures:
        draw(folder, views, one, found)
    print(f"figures: body {body}; written into {folder}")
    return 0


if __name__ == "__main__":
    # ParaView runs the filter's text in __main__, where it then shadows min, max and others: this
    # file works as a module of its own.
    sys.dont_write_bytecode = True
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    import figures
    sys.exit(figures.main())
