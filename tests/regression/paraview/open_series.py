# SPDX-License-Identifier: GPL-2.0-or-later
"""Requirement: ParaView opens the three series of a run directory, and they agree with curve.csv.

Run by ParaView's own Python:  pvpython open_series.py DIR
Checks that particles.pvd, bonds.pvd and platen.pvd have rising times (microseconds) inside the run,
the arrays that the contract names, as many bonds as the run began with, as many broken ones as
curve.csv counts at that time, and the platen at the height that curve.csv gives, which is an average.
Exit status: 0 all checks hold, 1 one does not (all are listed), 2 the directory cannot be read.
"""
import bisect
import csv
import os
import sys

from paraview import servermanager, simple

POINT_ARRAYS = {"id", "type", "body", "radius", "v", "f", "bonds_intact", "bonds_broken"}
BOND_ARRAYS = {"tag_i", "tag_j", "body", "state", "mode", "sigma_MPa", "tau_MPa"}
PLATEN_ARRAYS = {"wall", "pressure_MPa"}
HEIGHT_TOLERANCE = 1e-3  # um, beyond the change between two rows of the curve
# The curve's gap is a mean over a window of at most 0.1 um of travel, exact to one of its 32 blocks; a
# frame shows the gap of the moment, at most half a window further.
AVERAGE_LAG = 0.5 * 0.1 * 33 / 32
TIME_TOLERANCE = 1e-6  # us; curve.csv and the .pvd files round times to fewer digits than a double


class Curve:
    """Columns of curve.csv; `between` gives the range of a value around a time."""

    def __init__(self, file):
        with open(file, newline="") as stream:
            rows = list(csv.DictReader(line for line in stream if not line.startswith("#")))
        self.time = [float(row["time_us"]) for row in rows]
        self.rows = rows

    def between(self, column, time):
        first = max(bisect.bisect_left(self.time, time - TIME_TOLERANCE) - 1, 0)
        last = min(bisect.bisect_right(self.time, time + TIME_TOLERANCE), len(self.rows) - 1)
        values = [float(row[column]) for row in self.rows[first:last + 1]]
        return min(values), max(values)

    def covers(self, time):
        """False for a frame before the first row: nothing to compare it with."""
        return time >= self.time[0] - TIME_TOLERANCE

    def output_step(self):
        return max(b - a for a, b in zip(self.time, self.time[1:]))


class Checks:
    def __init__(self):
        self.done, self.failed = 0, []

    def __call__(self, holds, what):
        self.done += 1
        if not holds:
            self.failed.append(what)


def array_names(attributes):
    return {attributes.GetArrayName(i) for i in range(attributes.GetNumberOfArrays())}


def frames(file):
    """(time, data) of every frame, as ParaView sees them."""
    reader = simple.PVDReader(FileName=file)
    reader.UpdatePipelineInformation()
    times = reader.TimestepValues
    for time in [times] if isinstance(times, float) else list(times):
        reader.UpdatePipeline(time)
        data = servermanager.Fetch(reader)
        while data.IsA("vtkMultiBlockDataSet") or data.IsA("vtkPartitionedDataSet"):
            data = data.GetBlock(0) if data.IsA("vtkMultiBlockDataSet") else data.GetPartition(0)
        yield time, data


def check_times(name, times, curve, check):
    check(len(times) >= 2, f"{name}: {len(times)} frames, at least 2 expected")
    check(all(a < b for a, b in zip(times, times[1:])), f"{name}: times do not rise: {times}")
    last = curve.time[-1] + curve.output_step() + TIME_TOLERANCE
    check(times and times[0] >= -TIME_TOLERANCE and times[-1] <= last,
          f"{name}: times {times[:1]}..{times[-1:]} us leave the run's 0..{curve.time[-1]} us")


def check_particles(time, data, first, check):
    missing = POINT_ARRAYS - array_names(data.GetPointData())
    check(not missing, f"particles at {time} us: arrays missing: {sorted(missing)}")
    check(data.GetNumberOfPoints() == first,
          f"particles at {time} us: {data.GetNumberOfPoints()} instead of {first}")
    if not missing:
        low, _ = data.GetPointData().GetArray("radius").GetRange()
        check(low > 0, f"particles at {time} us: smallest radius {low} um")


def check_bonds(time, data, first, curve, check):
    missing = BOND_ARRAYS - array_names(data.GetCellData())
    check(not missing, f"bonds at {time} us: arrays missing: {sorted(missing)}")
    check(data.GetNumberOfCells() == first,
          f"bonds at {time} us: {data.GetNumberOfCells()} lines instead of {first}")
    if "state" in missing or not curve.covers(time):
        return
    state = data.GetCellData().GetArray("state")
    broken = sum(state.GetTuple1(i) == 0 for i in range(state.GetNumberOfTuples()))
    low, high = curve.between("bonds_broken", time)
    check(low <= broken <= high,
          f"bonds at {time} us: {broken} broken, curve.csv counts {low:.0f} to {high:.0f}")


def check_platen(time, data, curve, check):
    missing = PLATEN_ARRAYS - array_names(data.GetCellData())
    check(not missing, f"platen at {time} us: arrays missing: {sorted(missing)}")
    if not curve.covers(time):
        return
    bounds = data.GetBounds()
    low, high = curve.between("thickness_um", time)
    allowed = HEIGHT_TOLERANCE + AVERAGE_LAG
    check(low - allowed <= bounds[5] - bounds[4] <= high + allowed,
          f"platen at {time} us: gap {bounds[5] - bounds[4]:.4f} um, curve.csv {low} to {high}")


def initial_bonds(curve):
    row = max(curve.rows, key=lambda r: float(r["broken_fraction"]))
    fraction = float(row["broken_fraction"])
    return None if fraction == 0 else round(float(row["bonds_broken"]) / fraction)


def check_run(directory, check):
    curve = Curve(os.path.join(directory, "curve.csv"))
    series = {}
    for name in ("particles", "bonds", "platen"):
        file = os.path.join(directory, "vtk", name + ".pvd")
        if not os.path.exists(file):
            raise FileNotFoundError(file)
        series[name] = []
        first = initial_bonds(curve) if name == "bonds" else None
        for time, data in frames(file):
            series[name].append(time)
            if name == "particles":
                first = first or data.GetNumberOfPoints()
                check_particles(time, data, first, check)
            elif name == "bonds":
                first = first or data.GetNumberOfCells()
                check_bonds(time, data, first, curve, check)
            else:
                check_platen(time, data, curve, check)
        check_times(name, series[name], curve, check)
    check(series["particles"] == series["bonds"] == series["platen"],
          f"the series have different times: {series}")
    return series


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    check = Checks()
    try:
        series = check_run(sys.argv[1], check)
    except (OSError, KeyError, ValueError) as error:
        print(f"open_series: {sys.argv[1]}: cannot be read: {error!r}")
        return 2
    for failure in check.failed:
        print("open_series: FAILED:", failure)
    version = str(simple.GetParaViewVersion()).strip("()").replace(", ", ".")
    print(f"open_series: ParaView {version}: {len(series['particles'])} frames, {check.done} checks,"
          f" {len(check.failed)} failed")
    return 1 if check.failed else 0


if __name__ == "__main__":
    sys.exit(main())
