#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Decks whose shapes, images, meshes, voids and places are refused, with 3: `test_refused_shapes.py DEM_BATCH`."""
import refusal
from refusal import (BASE, DISC, FILE, MASK, MESH, POLYGON, REVERSED, RING, TALL, edit, jagged, without)

# name, text, messages
DECKS = [
    # shapes
    ("ring whose hole is larger", edit(RING, "inner_radius = 0.01 -> inner_radius = 0.03"),
     ["13:20 'inner_radius' in &body must be less than 'radius', 0.03 m, got 0.03 m"]),
    ("spacing larger than a ring is wide", edit(RING, "    spacing = 0.01 ->     spacing = 0.021"),
     ["14:5 'spacing' in &body must not exceed the ring's width, 0.02 m, got 0.021 m"]),
    ("keys missing for a ring", edit(BASE, "'rectangle' -> 'ring'"),
     ["11:1 'radius' in &body must be given for shape 'ring'",
      "11:1 'inner_radius' in &body must be given for shape 'ring'",
      "13:5 'size' in &body is not used by shape 'ring'"]),
    ("polygon of an odd number of coordinates", edit(POLYGON, "0,0.05 -> 0,0.05, 1"),
     ["13:5 'points' in &body must be pairs of x and y, got 9 values"]),
    ("polygon of two points", edit(POLYGON, "0.04,0.05, 0,0.05 -> 0,0"),
     ["13:5 'points' in &body must be at least 3 points, got 2"]),
    ("polygon of too many points", edit(POLYGON, "0,0.05 -> 20000*1"),
     ["13:5 'points' in &body must be at most 10000 points, got 10003"]),
    ("polygon with a side of no length", edit(POLYGON, "0.04,0.05 -> 0.04,0"),
     ["13:5 'points' in &body: from point 2, (0.04, 0) m, to the next, (0.04, 0) m, is no length to compute with"]),
    ("polygon that meets itself", edit(POLYGON, "0.04,0.05, 0,0.05 -> 0,0.05, 0.04,0.05"),
     ["13:5 'points' in &body: the polygon meets itself: edge 2, from (0.04, 0) m, and edge 4, from (0.04, 0.05) m"]),
    ("spacing larger than the polygon", edit(POLYGON, "    spacing = 0.01 ->     spacing = 0.041"),
     ["14:5 'spacing' in &body must not exceed the polygon's extent, 0.04 m x 0.05 m, got 0.041 m"]),
    ("polygon between nodes",
     jagged(edit(POLYGON, "points = 0,0, 0.04,0, 0.04,0.05, 0,0.05 -> points = 0,0.001, 0.04,0.05, 0.0401,0.05")),
     ["11:1 body 1: its outline, voids and pores leave none of 52 nodes"]),
    ("void of a polygon that meets itself",
     BASE + "&void shape = 'polygon', centre = 0, 0.02, points = 0,0, 1,1, 1,0, 0,1 /\n",
     ["27:44 'points' in &void: the polygon meets itself: edge 1, from (0, 0) m, and edge 3, from (1, 0) m"]),
    ("angle of a round void", BASE + "&void centre = 0, 0.02, radius = 0.005, angle = 0 /\n",
     ["27:41 'angle' in &void is not used by shape 'disc'"]),
    ("void of a polygon outside its body",
     BASE + "&void shape = 'polygon', centre = 0, 0.02, points = 1,0, 2,0, 1,1 /\n",
     ["27:26 void takes no node of body 1: its centre is in the body's own coordinates"]),
    ("void of a mesh", MESH + "&void centre = 0, 0.02, radius = 0.005 /\n",
     ["26:1 &void is for body 1, which is of shape 'mesh'"]),
    ("pores of a mesh", MESH + "&pores number = 1, radius = 5e-3, 6e-3 /\n",
     ["26:1 &pores is for body 1, which is of shape 'mesh'"]),
    ("part on a node only", jagged(BASE + "&void shape = 'rectangle', centre = -0.0125, 0.017320508, size = 0.0235, 1e-3 /\n"
     "&void shape = 'rectangle', centre = 0.0125, 0.017320508, size = 0.0235, 1e-3 /\n"),
     ["11:1 body 1 has 1 part that shares no edge with its largest, of 8 triangles at (-0.02, 0) m in its own "
      "coordinates; 'disconnected' can remove or keep such parts"]),
    # pores
    ("pores without a number", BASE + "&pores radius = 5e-3, 6e-3 /\n",
     ["27:1 'number' or 'porosity' in &pores must be given"]),
    ("pores with a number and a porosity", BASE + "&pores number = 1, porosity = 0.1, radius = 5e-3, 6e-3 /\n",
     ["27:20 'porosity' in &pores does not go with 'number'"]),
    ("porosity of 1", BASE + "&pores porosity = 1, radius = 5e-3, 6e-3 /\n",
     ["27:19 'porosity' in &pores must be in (0, 1), got 1"]),
    ("porosity that needs too many pores", BASE + "&pores porosity = 0.1, radius = 2*1e-5 /\n",
     ["27:8 'porosity' in &pores, 0.1, needs more than 10000 pores of such radii in body 1"]),
    ("porosity that finds no place", BASE + "&pores porosity = 0.5, radius = 5e-3, 6e-3, wall = 1e-3 /\n",
     ["27:1 pore 9 of 11, of radius 0.00512812 m, finds no place in body 1 with walls of 0.001 m; take fewer or "
      "smaller ones, or a thinner 'wall'"]),
    ("normal pores without a mean", BASE + "&pores number = 1, radius = 5e-3, 6e-3, distribution = 'normal' /\n",
     ["27:1 'mean' in &pores must be given for distribution 'normal'",
      "27:1 'deviation' in &pores must be given for distribution 'normal'"]),
    ("radii that hardly ever come", BASE + "&pores number = 1, radius = 5e-3, 6e-3, distribution = 'normal',\n"
     "mean = 1, deviation = 1e-3 /\n",
     ["28:1 'mean' and 'deviation' in &pores, 1 m and 0.001 m, give next to no radius from 0.005 m to 0.006 m"]),
    # inclusions
    ("inclusion without a material", BASE + "&inclusion centre = 0, 0.02, radius = 0.01 /\n",
     ["27:1 'material' in &inclusion must be given"]),
    ("inclusion of an unknown material", BASE + "&inclusion material = 'ruber', centre = 0, 0.02, radius = 0.01 /\n",
     ["27:12 there is no material 'ruber' (did you mean 'rubber'?)"]),
    ("inclusion that misses its body", BASE + "&inclusion material = 'rubber', centre = 1, 0.02, radius = 0.01 /\n",
     ["27:33 inclusion has no triangle of body 1: its centre is in the body's own coordinates"]),
    ("inclusion of equal springs", BASE + "&material name = 'raw', bond_stiffness = 1, density = 1 /\n"
     "&inclusion material = 'raw', centre = 0, 0.02, radius = 0.01 /\n",
     ["15:5 body 1: a bond stiffness, 1 N, is for bodies of one material"]),
    # cracks
    ("crack of an odd number of coordinates", BASE + "&crack points = 0, 0, 1, 1, 2 /\n",
     ["27:8 'points' in &crack must be pairs of x and y, got 5 values"]),
    ("crack of no length", BASE + "&crack points = 0, 0, 1, 1, 1, 1 /\n",
     ["27:8 'points' in &crack: from point 2, (1, 1) m, to the next, (1, 1) m, is no length to compute with"]),
    ("crack that misses its body", BASE + "&crack points = 0.03, 0, 0.03, 0.1 /\n",
     ["27:8 crack crosses no triangle of body 1: its points are in the body's own coordinates"]),
    ("crack of a body that does not exist", BASE + "&crack body = 2, points = 0.03, 0, 0.03, 0.1 /\n",
     ["27:8 &crack is for body 2, but the number of bodies is 1"]),
    ("crack of a lattice file", FILE + "&crack points = 0, 0, 1, 1 /\n",
     ["25:1 &crack is for body 1, which is of shape 'file'"]),
    ("crack that takes everything", MESH + "&crack points = 0, 0, 1, 1 /\n",
     ["11:1 body 1: its cracks leave none of 1 triangles"]),
    ("crack through the body", BASE + "&crack points = -0.1, 0.02, 0.1, 0.02 /\n",
     ["11:1 body 1 has 1 part that shares no edge with its largest, of 14 triangles at (-0.02, 0) m in its own "
      "coordinates; 'disconnected' can remove or keep such parts"]),
    # masks and meshes
    ("mask without a name", edit(MASK, "good.pgm -> "),
     ["13:5 'file' in &body must name an image, got ''"]),
    ("mask without a scale", without(MASK, ", scale = 0.01"),
     ["11:1 'scale' in &body must be given for shape 'mask'"]),
    ("mask missing", edit(MASK, "good -> none"),
     ["13:5 body 1: none.pgm: No such file or directory"]),
    ("mask that is no image", edit(MASK, "good.pgm -> deck.nml"),
     ["13:5 body 1: deck.nml: neither a PGM image (P2, P5) nor a PNG image"]),
    ("mask with a pixel too bright", edit(MASK, "good -> bad"),
     ["13:5 body 1: bad.pgm:6: a pixel must be in [0, 255], got 256"]),
    ("mask of absurd size", edit(MASK, "good -> large", "    spacing = 0.01 ->     spacing = 1"),
     ["13:5 body 1: large.pgm:1: 30000 x 30000 pixels take 900000000 bytes, but 3 follow the header"]),
    ("mask that is black", edit(MASK, "good -> black"),
     ["11:1 body 1: its outline, voids and pores leave none of 52 nodes; bright pixels are material: for the dark ones "
      "give 'invert = .true.'"]),
    ("spacing larger than the image", edit(MASK, "    spacing = 0.01 ->     spacing = 0.041"),
     ["14:5 'spacing' in &body must not exceed the image, 0.04 m x 0.05 m, got 0.041 m"]),
    ("threshold above 1", edit(MASK, "scale = 0.01 -> scale = 0.01, threshold = 1.1"),
     ["13:50 'threshold' in &body must be in [0, 1], got 1.1"]),
    ("mesh without a name", edit(MESH, "good.msh -> "),
     ["13:5 'file' in &body must name a mesh, got ''"]),
    ("mesh with a spacing", edit(MESH, "scale = 0.01 -> scale = 0.01, spacing = 0.01"),
     ["13:38 'spacing' in &body is not used by shape 'mesh'"]),
    ("mesh missing", edit(MESH, "good -> none"),
     ["13:5 body 1: none.msh: No such file or directory"]),
    ("mesh that is an image", edit(MESH, "good.msh -> good.pgm"),
     ["13:5 body 1: good.pgm:1: '$MeshFormat' is expected, got 'P2'"]),
    ("mesh with a node that is not there", edit(MESH, "good -> bad"),
     ["13:5 body 1: bad.msh:17: there is no node 4"]),
    ("mesh of absurd size", edit(MESH, "good -> large"),
     ["13:5 body 1: large.msh:5: 4000000000 nodes do not fit in the 94 bytes that follow"]),
    ("mesh of quadrangles", edit(MESH, "good -> quads"),
     ["13:5 body 1: quads.msh:16: elements of type 3; only triangles of 3 nodes, type 2, can be read"]),
    ("mesh scaled to nothing", edit(MESH, "scale = 0.01 -> scale = 1e-200"),
     ["13:24 body 1: the area of a triangle, 0 m^2, is too small; its sides are 0 m"]),
    # geometry
    ("void that takes everything", jagged(BASE + "&void centre = 0, 0.02, radius = 1 /\n"),
     ["11:1 body 1: its outline, voids and pores leave none of 32 nodes"]),
    ("a loose part", jagged(BASE + "&void shape = 'rectangle', centre = 0, 0.025, size = 0.06, 0.02 /\n"),
     ["11:1 body 1 has 1 part that shares no edge with its largest, of 7 triangles at (-0.015, 0.0433013) m in "
      "its own coordinates; 'disconnected' can remove or keep such parts"]),
    ("three loose parts", jagged(TALL),
     ["11:1 body 1 has 3 parts that share no edge with its largest, of 35 triangles at (-0.015, 0.112583), 14 at "
      "(-0.02, 0), 14 at (-0.015, 0.181865) m in its own coordinates; 'disconnected' can remove or keep such parts"]),
    ("pores that find no place", BASE + "&pores number = 20, radius = 5e-3, 6e-3, wall = 1e-3 /\n",
     ["27:1 pore 8 of 20, of radius 0.00553882 m, finds no place in body 1 with walls of 0.001 m; take fewer or "
      "smaller ones, or a thinner 'wall'"]),
    ("pores larger than the body", BASE + "&pores number = 1, radius = 0.05, 0.06 /\n",
     ["27:1 pore 1 of 1, of radius 0.0541702 m, finds no place in body 1 with walls of 0.02 m, the default; take "
      "fewer or smaller ones, or a thinner 'wall'"]),
    ("void outside its body", BASE + "&void centre = 0, -0.01, radius = 0.005 /\n",
     ["27:7 void takes no node of body 1: its centre is in the body's own coordinates"]),
    ("voids of which one is where the body is placed", edit(BASE, "0, 0.001 -> 1, 1") +
     "&void centre = 0, 0.02, radius = 0.009 /\n&void shape = 'rectangle', centre = 1, 1.02, size = 0.02, 0.02 /\n",
     ["28:28 void takes no node of body 1: its centre is in the body's own coordinates"]),
    ("numbers of nodes that overflow", edit(BASE, "0.04, 0.05 -> 1e300, 1e300", "0.01\n -> 1e-300\n"),
     ["14:5 body 1 would have more nodes than 2^40 with the spacing 1e-300 m"]),
    ("spacing far too small", edit(BASE, "0.01\n -> 1e-300\n"),
     ["14:5 body 1 would have more nodes than 2^40 with the spacing 1e-300 m"]),
    ("position far away", jagged(edit(BASE, "0, 0.001 -> 0, 1e300")),
     ["16:5 body 1 has coordinates of up to 1e+300 m, so large that rounding blurs its spacing of 0.01 m"]),
    ("masses that underflow", edit(BASE, "1050 -> 1e-308", "thickness = 1 -> thickness = 1e-308"),
     ["15:5 body 1: the mass of a node, 0 kg, is too small; density 1e-308 kg/m^3, thickness 1e-308 m, spacing "
      "0.01 m"]),
    ("areas that underflow", jagged(edit(BASE, "0.04, 0.05 -> 2*1e-200", "0.01\n -> 1e-200\n")),
     ["14:5 body 1: the area of a triangle, 0 m^2, is too small; its sides are 1e-200 m"]),
    ("masses that overflow", edit(BASE, "1050 -> 1e308", "thickness = 1 -> thickness = 1e308"),
     ["15:5 body 1: the mass of a node, inf kg, is too large; density 1e+308 kg/m^3, thickness 1e+308 m, spacing "
      "0.01 m"]),
    ("stiffness that underflows", edit(BASE, "1e7 -> 1e-308"),
     ["15:5 body 1: the stiffness of a spring, 1e-310 N, is too small; Young's modulus 1e-308 Pa, thickness 1 m, "
      "spacing 0.01 m"]),
    ("frequency that overflows", edit(BASE, "1e7 -> 1e300") + "&solver max_step = 1e-6 /\n",
     ["12:5 body 1: stiffness over mass is too large to compute with"]),
    ("damping that overflows", edit(BASE, "thickness = 1 -> damping_time = 1e200"),
     ["15:5 body 1: the damping of a spring, 6.59829e+208 1/s, is too large; damping_time 1e+200 s"]),
    ("clearance far away", jagged(edit(BASE, "position = 0, 0.001 -> clearance = 1e300")),
     ["16:5 body 1 has coordinates of up to 1e+300 m, so large that rounding blurs its spacing of 0.01 m"]),
    ("obstacle that overflows", edit(BASE, "-0.1, 0, 0.1, 0 -> -1e300, 0, 1e300, 0"),
     ["20:5 'points' in &obstacle: segment 1 of obstacle 1, from (-1e+300, 0) to (1e+300, 0) m, is too long"]),
    ("body deeper in the obstacle than the penetration tolerance", jagged(edit(BASE, "0, 0.001 -> 0, -0.001")),
     ["11:1 body 1 starts 0.001 m inside obstacle 1, at (-0.02, -0.001) m, deeper than the penetration tolerance of 1e-08 m; "
      "'position' or 'clearance' can put it in front" + REVERSED]),
    ("body just deeper than the penetration tolerance", jagged(edit(BASE, "0, 0.001 -> 0, -1.1e-8")),
     ["11:1 body 1 starts 1.1e-08 m inside obstacle 1, at (-0.02, -1.1e-08) m, deeper than the penetration tolerance of 1e-08 m; "
      "'position' or 'clearance' can put it in front" + REVERSED]),
    ("second body in the obstacle",
     jagged(BASE + "&body shape = 'disc', radius = 0.02, spacing = 0.01, material = 'rubber', position = 0.06, 0 /\n"),
     ["27:1 body 2 starts 0.0173205 m inside obstacle 1, at (0.05, -0.0173205) m, deeper than the penetration tolerance of 1e-08 m; "
      "'position' or 'clearance' can put it in front" + REVERSED]),
    ("two bodies in two obstacles", jagged(edit(BASE, "0, 0.001 -> 0, -0.001") + "&obstacle points = 0.2, 0, 0.1, 0 /\n"
     "&body shape = 'disc', radius = 0.02, spacing = 0.01, material = 'rubber', position = 0.15, 0.01 /\n"),
     ["11:1 body 1 starts 0.001 m inside obstacle 1, at (-0.02, -0.001) m, deeper than the penetration tolerance of 1e-08 m; "
      "'position' or 'clearance' can put it in front" + REVERSED,
      "28:1 body 2 starts 0.0273205 m inside obstacle 2, at (0.14, 0.0273205) m, deeper than the penetration tolerance of 1e-08 m; "
      "'position' or 'clearance' can put it in front" + REVERSED]),
    ("body deeper than the penetration tolerance given", edit(BASE, "0, 0.001 -> 0, -0.001") + "&contact penetration_tolerance = 1e-4 /\n",
     ["11:1 body 1 starts 0.001 m inside obstacle 1, at (-0.02, -0.001) m, deeper than the penetration tolerance of 0.0001 m; "
      "'position' or 'clearance' can put it in front" + REVERSED]),
    ("point of an obstacle between nodes", jagged(edit(BASE, "position = 0, 0.001 -> position = 0, 1e-4") +
     "&obstacle points = 0.001, -0.02, 0.002, 0.004, 0.003, -0.02 /\n"),
     ["11:1 body 1 starts with point 2 of obstacle 2, at (0.002, 0.004) m, 0.0039 m inside it between its nodes, "
      "deeper than the penetration tolerance of 1e-08 m; 'position' or 'clearance' can put it in front"]),
    ("obstacle the wrong way round", jagged(edit(BASE, "-0.1, 0, 0.1, 0 -> 0.1, 0, -0.1, 0")),
     ["11:1 body 1 starts 0.0529615 m inside obstacle 1, at (-0.02, 0.0529615) m, deeper than the penetration tolerance of 1e-08 m; "
      "'position' or 'clearance' can put it in front" + REVERSED]),
    ("obstacle the wrong way round under a clearance", jagged(edit(BASE, "position = 0, 0.001 -> position = 0, 0.2\n    clearance = 1e-3",
                                                            "-0.1, 0, 0.1, 0 -> 0.1, 0, 0, 0, -0.2, 0.1")),
     ["11:1 body 1 starts 0.0630796 m inside obstacle 1, at (0.02, 0.0630796) m, deeper than the penetration tolerance of 1e-08 m; "
      "'position' or 'clearance' can put it in front" + REVERSED]),
    ("clearance with nothing below", edit(BASE, "position = 0, 0.001 -> position = 1, 0.1\n    clearance = 1e-3"),
     ["17:5 'clearance' in &body cannot be reached: along gravity there is no obstacle below body 1; move it"
      + REVERSED]),
    ("clearance against gravity", edit(BASE, "position = 0, 0.001 -> clearance = 1e-3", "-9.81 -> 9.81"),
     ["16:5 'clearance' in &body cannot be reached: along gravity there is no obstacle below body 1; move it"
      + REVERSED]),
    ("lattice file missing", FILE,
     ["13:5 body 1: part.h5: cannot be opened (No such file or directory)"]),
    ("lattice file that is not HDF5", edit(FILE, "part.h5 -> deck.nml"),
     ["13:5 body 1: deck.nml: is not an HDF5 file"]),
    ("lattice file that is a folder", edit(FILE, "part.h5 -> ."),
     ["13:5 body 1: .: is not a regular file"]),
    ("lattice file given by its whole path", edit(FILE, "part.h5 -> /nowhere/part.h5"),
     ["13:5 body 1: /nowhere/part.h5: cannot be opened (No such file or directory)"]),
]


class Refused(refusal.Refusal):
    def test_decks(self):
        self.refuse_all(DECKS)


if __name__ == "__main__":
    refusal.main()
