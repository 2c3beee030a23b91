#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes docs/examples/run.pvsm: `xvfb-run -a pvpython write_paraview_state.py plot_paraview.py run.pvsm` in a folder with
a run of the name `run`. It is the state that plot_paraview.py saves, with colours that grow with the stress, and without
what ParaView sets by itself, four fifths of it: what is left can be read, and is less likely to trouble other versions."""
import runpy
import sys
import xml.etree.ElementTree as xml

from paraview import servermanager, simple

script, state = sys.argv[1:3]
# Parts of views and representations that are not shown here, such as axes and forms of glyphs.
UNUSED = {"ArrowSource", "ColorPalette", "ConeSource", "CubeSource", "CylinderSource", "GlyphSource2D", "GridAxes3DActor",
          "GridAxesRepresentation", "LegendGridActor", "LineSource", "PolarAxesRepresentation", "PolarGridActor",
          "RepresentationAnimationHelper", "SphereSource", "Transform2"}


def is_its_own(proxy, name):
    """Whether ParaView sets a property by itself: to a default, or to what it finds in files."""
    found = servermanager.ActiveConnection.Session.GetRemoteObject(int(proxy))
    known = found.GetProperty(name) if found is not None else None
    return known is not None and (known.IsValueDefault() or known.GetInformationOnly() != 0)


def is_needless(item, parent, unused):
    if item.tag == "Property" and parent.tag == "Proxy":
        refers = any(other.get("value") in unused for other in item.iter("Proxy"))
        return len(item) == 0 or refers or is_its_own(parent.get("id"), item.get("name"))
    return item.tag in ("Domain", "Hints") or item.get("id") in unused


def prune(item, unused):
    for child in list(item):
        if is_needless(child, item, unused):
            item.remove(child)
        else:
            prune(child, unused)
    item.text = item.tail = None


sys.argv = [script, "run.vtkhdf", state]
runpy.run_path(script, run_name="__main__")
colours = simple.GetColorTransferFunction("von_mises")
colours.AutomaticRescaleRangeMode = "Grow and update every timestep"
colours.RescaleTransferFunction(0.0, 1.0)
simple.SaveState(state)
tree = xml.parse(state)
prune(tree.getroot(), {proxy.get("id") for proxy in tree.iter("Proxy") if proxy.get("type") in UNUSED})
xml.indent(tree, " ")
tree.write(state)
