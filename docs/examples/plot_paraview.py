#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the bodies of a frame, filled and coloured by von Mises stress, and the obstacles:
`pvpython plot_paraview.py RUN.vtkhdf OUT.png [FRAME]`. Frames count from 0, -1 is the last. With OUT.pvsm in the place of
OUT.png it saves that as a state, which ParaView opens by File, Load State; springs are in it, too, and not shown. It needs
ParaView 5.12 or newer, and a display: `xvfb-run -a pvpython ...` without one."""
import os
import sys

from paraview import servermanager, simple

if len(sys.argv) < 3:
    sys.exit(__doc__)
path, out = sys.argv[1:3]
stem = path.removesuffix(".vtkhdf")

simple._DisableFirstRenderCameraReset()
view = simple.CreateRenderView(ViewSize=[1200, 900], InteractionMode="2D", OrientationAxesVisibility=0,
                               UseColorPaletteForBackground=0, Background=[1, 1, 1])
bodies = simple.VTKHDFReader(registrationName="bodies", FileName=stem + ".body.vtkhdf")
springs = simple.VTKHDFReader(registrationName="springs", FileName=path)
times = bodies.TimestepValues
frame = range(len(times))[int(sys.argv[3]) if len(sys.argv) > 3 else -1]
scene = simple.GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
scene.AnimationTime = times[frame]
bodies.UpdatePipeline(times[frame])

shown = simple.Show(bodies, view, Ambient=1, Diffuse=0)  # colours as they are, without a lamp's shade
if "von_mises" in bodies.PointData.keys():
    simple.ColorBy(shown, ("POINTS", "von_mises"))
    colours = simple.GetColorTransferFunction("von_mises")
    presets = servermanager.vtkSMTransferFunctionPresets.GetInstance()
    names = map(presets.GetPresetName, range(presets.GetNumberOfPresets()))
    colours.ApplyPreset(next(name for name in names if name.startswith("Viridis")), True)  # "(matplotlib)" before 6
    shown.RescaleTransferFunctionToDataRange(False, True)
    bar = simple.GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle, bar.TitleColor, bar.LabelColor = "von Mises, Pa", "", [0, 0, 0], [0, 0, 0]
    shown.SetScalarBarVisibility(view, True)
simple.Hide(springs, view)
if os.path.exists(stem + ".obstacle.vtkhdf"):
    obstacles = simple.VTKHDFReader(registrationName="obstacles", FileName=stem + ".obstacle.vtkhdf")
    simple.Show(obstacles, view, Ambient=1, Diffuse=0, AmbientColor=[0.5] * 3, DiffuseColor=[0.5] * 3, LineWidth=4)
simple.Show(simple.AnnotateTime(registrationName="time", Format="t = {time:.4g} s"), view,
            Color=[0, 0, 0], WindowLocation="Upper Left Corner")

left, right, bottom, top, _, _ = bodies.GetDataInformation().GetBounds()
middle = [(left + right) / 2, (bottom + top) / 2]
view.CameraFocalPoint, view.CameraPosition, view.CameraViewUp = [*middle, 0], [*middle, 1], [0, 1, 0]
view.CameraParallelScale = 0.6 * max(top - bottom, 0.75 * (right - left))
simple.Render(view)
if out.endswith(".pvsm"):
    simple.SaveState(out)
else:
    simple.SaveScreenshot(out, view)
