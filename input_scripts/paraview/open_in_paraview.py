# SPDX-License-Identifier: GPL-2.0-or-later
"""A run in ParaView: particles with their radii, a colour for each body, and bonds coloured by their state.

  paraview --script=open_in_paraview.py   in the run's folder; or ParaView, Tools > Python Shell > Run Script
  pvpython open_in_paraview.py            only writes run.pvsm there, which ParaView opens as a state

`calendem run` and `collect` put this file into the run's folder.
"""
import os

from paraview import simple

RUN = os.path.dirname(os.path.abspath(__file__)) if "__file__" in globals() else os.getcwd()


def series(name):
    return simple.PVDReader(registrationName=name, FileName=os.path.join(RUN, "vtk", name + ".pvd"))


view = simple.GetActiveView() or simple.CreateView("RenderView")
view.UseColorPaletteForBackground = 0
view.Background = [1.0, 1.0, 1.0]

particles = series("particles")
spheres = simple.Show(particles, view)
spheres.SetRepresentationType("Point Gaussian")
spheres.ShaderPreset = "Sphere"
spheres.GaussianRadius = 1.0
spheres.ScaleByArray = 1
spheres.SetScaleArray = ["POINTS", "radius"]
spheres.UseScaleFunction = 0
simple.ColorBy(spheres, ("POINTS", "body"))
simple.GetColorTransferFunction("body").ApplyPreset("Rainbow Uniform", True)

bonds = simple.Show(series("bonds"), view)
bonds.LineWidth = 3
simple.ColorBy(bonds, ("CELLS", "state"))
state = simple.GetColorTransferFunction("state")  # 0 broken: red; 1 intact: grey
state.RGBPoints = [0.0, 0.8, 0.1, 0.1, 1.0, 0.55, 0.6, 0.65]

platen = simple.Show(series("platen"), view)
platen.Opacity = 0.3

particles.UpdatePipeline(particles.TimestepValues[0])
bounds = particles.GetDataInformation().GetBounds()
centre = [0.5 * (bounds[k] + bounds[k + 1]) for k in (0, 2, 4)]
size = max(bounds[k + 1] - bounds[k] for k in (0, 2, 4))
view.CameraParallelProjection = 1
view.CameraFocalPoint = centre
view.CameraPosition = [centre[0] + 1.3 * size, centre[1] - 2.4 * size, centre[2] + 0.7 * size]
view.CameraViewUp = [0, 0, 1]
view.CameraParallelScale = 0.6 * size
simple.SaveState(os.path.join(RUN, "run.pvsm"))
print("state: " + os.path.join(RUN, "run.pvsm"))
