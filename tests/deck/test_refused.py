#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Decks whose text, keys or values are refused, with 3, and command lines, with 2: `test_refused.py DEM_BATCH`."""
import os

import refusal
from refusal import (BASE, DISC, FILE, MESH, OBSTACLE, ROUGH, edit, jagged, stderr_of, without)

# name, text, messages
DECKS = [
    # names
    ("unknown group", edit(BASE, "&obstacle -> &obstacel"),
     ["19:1 unknown group &obstacel (did you mean &obstacle?)"]),
    ("unknown group like no other", BASE + "&weather temperature = 3 /\n",
     ["27:1 unknown group &weather"]),
    ("unknown key", edit(BASE, "density -> densty"),
     ["8:5 unknown key 'densty' in &material (did you mean 'density'?)"]),
    ("unknown key like no other", edit(BASE, "thickness = 1 -> colour = 'red'"),
     ["9:5 unknown key 'colour' in &material"]),
    ("beginning of a key", edit(BASE, "youngs_modulus -> youngs"),
     ["7:5 unknown key 'youngs' in &material (did you mean 'youngs_modulus'?)"]),
    ("key of another group", edit(BASE, "t_end = 1e-3 -> t_end = 1e-3\n    rtol = 1e-6"),
     ["3:5 unknown key 'rtol' in &run"]),
    ("member of a key", BASE + "&contact penetration_tolerance%depth = 1e-8 /\n",
     ["27:10 unknown key 'penetration_tolerance%depth' in &contact (did you mean 'penetration_tolerance'?)"]),
    ("renamed key", BASE + "&contact skin = 1e-8 /\n",
     ["27:10 unknown key 'skin' in &contact: it is called 'penetration_tolerance' now"]),
    ("faults in order of their place",
     edit(BASE, "t_end = 1e-3 -> t_end = -1", "1050 -> 'heavy'", "velocity -> velocty", "= 0.5 -> = 2"),
     ["2:13 't_end' in &run must be > 0, got -1",
      "8:15 'density' in &material expects a real, got 'heavy'",
      "17:5 unknown key 'velocty' in &body (did you mean 'velocity'?)",
      "21:19 'restitution' in &obstacle must be in [0, 1], got 2"]),
    ("missing key", without(BASE, "    t_end = 1e-3\n"),
     ["1:1 't_end' in &run must be given"]),
    ("two missing keys", without(BASE, "    youngs_modulus = 1e7\n", "    density = 1050\n"),
     ["5:1 'density' in &material must be given",
      "5:1 'youngs_modulus' or 'bond_stiffness' in &material must be given"]),
    ("missing group", without(BASE, "&run\n    t_end = 1e-3\n    gravity = 0, -9.81\n/\n"),
     ["1:1 &run must be given"]),
    ("text without groups", "Dear reader,\nthis is not a deck.\n",
     ["1:1 &run must be given",
      "1:1 &body must be given"]),
    ("repeated key", edit(BASE, "density = 1050 -> density = 1050\n    density = 1100"),
     ["9:5 key 'density' is given twice in &material, first in line 8"]),
    ("repeated single group", BASE + "&run t_end = 2e-3 /\n",
     ["27:1 &run is given twice, first in line 1"]),
    ("repeated optional group", BASE + "&solver rtol = 1e-6 /\n&solver rtol = 1e-7 /\n",
     ["28:1 &solver is given twice, first in line 27"]),
    # types
    ("velocity that is no number", edit(BASE, "restitution = 0.5 -> velocity = 1, nan"),
     ["21:19 'velocity': 'nan' is not a finite number"]),
    ("velocity without y", edit(BASE, "restitution = 0.5 -> velocity = 1"),
     ["21:5 'velocity' in &obstacle expects 2 values, got 1"]),
    ("string for a real", edit(BASE, "t_end = 1e-3 -> t_end = '1e-3'"),
     ["2:13 't_end' in &run expects a real, got '1e-3'"]),
    ("word for a real", edit(BASE, "t_end = 1e-3 -> t_end = 1ms"),
     ["2:13 't_end' in &run expects a real, got '1ms'"]),
    ("logical for a real", edit(BASE, "t_end = 1e-3 -> t_end = .true."),
     ["2:13 't_end' in &run expects a real, got '.true.'"]),
    ("real for an integer", edit(BASE, "frame_interval = 1e-4 -> deflate = 1.0"),
     ["25:15 'deflate' in &output expects an integer, got '1.0'"]),
    ("string for an integer", edit(BASE, "frame_interval = 1e-4 -> deflate = '1'"),
     ["25:15 'deflate' in &output expects an integer, got '1'"]),
    ("number for a string", edit(BASE, "'block' -> 7"),
     ["24:12 'name' in &output expects a string in quotes, got 7"]),
    ("string without quotes", edit(BASE, "'block' -> block"),
     ["24:12 'name' in &output expects a string in quotes, got block"]),
    ("choice without quotes", edit(BASE, "'rectangle' -> rectangle"),
     ["12:13 'shape' in &body expects a string in quotes, got rectangle"]),
    ("path without quotes", edit(BASE, "'block' -> a/b"),
     ["24:12 'name' in &output expects a string in quotes, got a",
      "24:14 text right behind the '/' that ends &output; does a path lack its quotes?"]),
    ("NaN", edit(BASE, "1050 -> NaN"),
     ["8:15 'density': 'NaN' is not a finite number"]),
    ("Inf", edit(BASE, "-9.81 -> -inf"),
     ["3:18 'gravity': '-inf' is not a finite number"]),
    ("Infinity", edit(BASE, "1e7 -> +Infinity"),
     ["7:22 'youngs_modulus': '+Infinity' is not a finite number"]),
    ("real too large", edit(BASE, "1050 -> 1e999"),
     ["8:15 'density': '1e999' is too large for a real"]),
    ("integer too large", edit(BASE, "frame_interval = 1e-4 -> deflate = 99999999999999999999"),
     ["25:15 'deflate': '99999999999999999999' is too large for an integer"]),
    ("integer that a real cannot hold", BASE + "&pores number = 1, radius = 1e-3, 1e-3, seed = 9007199254740993 /\n",
     ["27:48 'seed' in &pores must be at most 2^53, got 9007199254740993"]),
    ("complex number", edit(BASE, "0, -9.81 -> (0, -9.81)"),
     ["3:15 a number is expected; complex ones are not understood"]),
    ("key without its equal sign behind another", edit(BASE, "density = -> density"),
     ["8:5 '=' is missing after 'density'"]),
    ("exponent without its letter", edit(BASE, "1e7 -> 1.0+7"),
     ["7:22 'youngs_modulus': '1.0+7' has an exponent without its letter; write 1.5e+3 for 1.5+3"]),
    # ranges
    ("Young's modulus 0", edit(BASE, "1e7 -> 0"),
     ["7:22 'youngs_modulus' in &material must be > 0, got 0"]),
    ("Young's modulus negative", edit(BASE, "1e7 -> -1e7"),
     ["7:22 'youngs_modulus' in &material must be > 0, got -1e7"]),
    ("density 0", edit(BASE, "1050 -> 0.0"),
     ["8:15 'density' in &material must be > 0, got 0.0"]),
    ("density negative", edit(BASE, "1050 -> -1050"),
     ["8:15 'density' in &material must be > 0, got -1050"]),
    ("thickness 0", edit(BASE, "thickness = 1 -> thickness = 0"),
     ["9:17 'thickness' in &material must be > 0, got 0"]),
    ("guard negative", edit(BASE, "thickness = 1 -> guard = -0.1"),
     ["9:13 'guard' in &material must be >= 0, got -0.1"]),
    ("Poisson's ratio of 1", edit(BASE, "thickness = 1 -> poissons_ratio = 1"),
     ["9:22 'poissons_ratio' in &material must be in (-1, 1), got 1"]),
    ("Poisson's ratio of 0.5 in plane strain", edit(BASE, "thickness = 1 -> plane = 'strain', poissons_ratio = 0.5"),
     ["9:23 'poissons_ratio' in &material must be < 0.5 in plane strain, got 0.5"]),
    ("no strength", edit(BASE, "thickness = 1 -> fracture = 'stress'"),
     ["5:1 'strength' or 'fracture_energy' in &material must be given for fracture 'stress'"]),
    ("strength negative", edit(BASE, "thickness = 1 -> fracture = 'stress', strength = -1e5"),
     ["9:37 'strength' in &material must be > 0, got -1e5"]),
    ("strength NaN", edit(BASE, "thickness = 1 -> fracture = 'stress', strength = nan"),
     ["9:37 'strength': 'nan' is not a finite number"]),
    ("fracture energy negative", edit(BASE, "thickness = 1 -> fracture = 'stress', fracture_energy = -3"),
     ["9:44 'fracture_energy' in &material must be > 0, got -3"]),
    ("fracture energy NaN", edit(BASE, "thickness = 1 -> fracture = 'stress', fracture_energy = nan"),
     ["9:44 'fracture_energy': 'nan' is not a finite number"]),
    ("critical stretch negative", edit(BASE, "thickness = 1 -> fracture = 'stretch', critical_stretch = -0.1"),
     ["9:46 'critical_stretch' in &material must be > 0, got -0.1"]),
    ("critical stretch NaN", edit(BASE, "thickness = 1 -> fracture = 'stretch', critical_stretch = nan"),
     ["9:46 'critical_stretch': 'nan' is not a finite number"]),
    ("strength and fracture energy by stretch",
     edit(BASE, "thickness = 1 -> fracture = 'stretch', critical_stretch = 0.1, strength = 1e5, fracture_energy = 3"),
     ["9:51 'strength' in &material is not used by fracture 'stretch'",
      "9:67 'fracture_energy' in &material is not used by fracture 'stretch'"]),
    # E G/(3.4 strength^2), and for squares sqrt(sqrt(3)/2) E G/(3.3 strength^2)
    ("spacing too coarse for softening", jagged(edit(BASE, "thickness = 1 -> fracture = 'stress', strength = 1e5, fracture_energy = 17")),
     ["15:5 body 1: triangles with edges of 0.01 m are too large for a strength of 100000 Pa and a fracture energy of 17 J/m^2, "
      "which need 0.005 m at most"]),
    ("squares too coarse for softening", edit(BASE, "thickness = 1 -> fracture = 'stress', strength = 1e5, fracture_energy = 16.5",
                                              "spacing = 0.01 -> spacing = 0.01, lattice = 'square'"),
     ["11:1 body 1: squares of 0.01 m are too large for a strength of 100000 Pa and a fracture energy of 16.5 J/m^2, "
      "which need 0.00465302 m at most"]),
    ("spacing 0", edit(BASE, "0.01\n -> 0\n"),
     ["14:15 'spacing' in &body must be > 0, got 0"]),
    ("spacing negative", edit(BASE, "0.01\n -> -0.01\n"),
     ["14:15 'spacing' in &body must be > 0, got -0.01"]),
    ("size 0", edit(BASE, "0.04, 0.05 -> 2*0"),
     ["13:12 'size' in &body must be > 0, got 0"]),
    ("size negative", edit(BASE, "0.04, 0.05 -> 0.04, -0.05"),
     ["13:18 'size' in &body must be > 0, got -0.05"]),
    ("radius 0", edit(DISC, "0.03 -> 0"),
     ["13:14 'radius' in &body must be > 0, got 0"]),
    ("radius negative", edit(DISC, "0.03 -> -0.03"),
     ["13:14 'radius' in &body must be > 0, got -0.03"]),
    ("t_end 0", edit(BASE, "t_end = 1e-3 -> t_end = 0"),
     ["2:13 't_end' in &run must be > 0, got 0"]),
    ("t_end negative", edit(BASE, "t_end = 1e-3 -> t_end = -1e-3"),
     ["2:13 't_end' in &run must be > 0, got -1e-3"]),
    ("frame_interval 0", edit(BASE, "1e-4 -> 0"),
     ["25:22 'frame_interval' in &output must be > 0, got 0"]),
    ("frame_interval negative", edit(BASE, "1e-4 -> -1e-4"),
     ["25:22 'frame_interval' in &output must be > 0, got -1e-4"]),
    ("clearance negative", edit(BASE, "position = 0, 0.001 -> clearance = -1e-4"),
     ["16:17 'clearance' in &body must be >= 0, got -1e-4"]),
    ("restitution above 1", edit(BASE, "restitution = 0.5 -> restitution = 1.01"),
     ["21:19 'restitution' in &obstacle must be in [0, 1], got 1.01"]),
    ("restitution negative", edit(BASE, "restitution = 0.5 -> restitution = -0.1"),
     ["21:19 'restitution' in &obstacle must be in [0, 1], got -0.1"]),
    ("friction negative", edit(BASE, "restitution = 0.5 -> friction = -0.1"),
     ["21:16 'friction' in &obstacle must be >= 0, got -0.1"]),
    ("friction of the paper above 1", edit(BASE, "restitution = 0.5 -> friction = 1.01, friction_law = 'paper'"),
     ["21:5 'friction' in &obstacle must be in [0, 1] for friction_law 'paper', got 1.01"]),
    ("friction of the paper not given", edit(BASE, "restitution = 0.5 -> friction_law = 'paper'"),
     ["19:1 'friction' in &obstacle must be given for friction_law 'paper', in [0, 1]: an impact leaves this part of "
      "the tangential velocity, and 1 is frictionless"]),
    ("friction law unknown", edit(BASE, "restitution = 0.5 -> friction = 0.5, friction_law = 'newton'"),
     ["21:36 'friction_law' in &obstacle must be 'coulomb' or 'paper', got 'newton'"]),
    ("boundary without side", BASE + "&boundary where = 'side' /\n",
     ["27:1 'side' in &boundary must be given for where 'side'"]),
    ("boundary with a box too many", BASE + "&boundary where = 'all', box = 0, 0, 1, 1 /\n",
     ["27:26 'box' in &boundary is not used by where 'all'"]),
    ("boundary fixed with a value", BASE + "&boundary where = 'all', force = 0, 1 /\n",
     ["27:26 'force' in &boundary is not used by kind 'fix'"]),
    ("displacement at once", BASE + "&boundary where = 'side', side = 'top', kind = 'displacement', displacement = 0, 1 /\n",
     ["27:1 'ramp' in &boundary must be > 0 for kind 'displacement'"]),
    ("traction on a list", BASE + "&boundary where = 'list', nodes = 1, kind = 'traction', traction = 0, 1 /\n",
     ["27:11 kind 'traction' in &boundary needs edges: 'where' must be 'side', 'box', 'disc' or 'all'"]),
    ("box upside down", BASE + "&boundary where = 'box', box = 1, 1, 0, 0 /\n",
     ["27:26 'box' in &boundary must be its lower left and its upper right corner"]),
    ("boundary of no body", BASE + "&boundary body = 2, where = 'all' /\n",
     ["27:11 there is no body 2: the deck has 1"]),
    ("boundary without nodes", BASE + "&boundary where = 'box', box = 1, 1, 2, 2 /\n",
     ["27:11 &boundary chooses no node of body 1: places are in the body's own coordinates"]),
    ("boundary of a node too far", BASE + "&boundary where = 'list', nodes = 3, 999 /\n",
     ["27:27 'nodes' in &boundary has node 999; the body has nodes 0 to 31"]),
    ("two motions of a corner", BASE + "&boundary where = 'side', side = 'left' /\n&boundary where = 'side', side = 'bottom', components = 'y' /\n",
     ["28:1 &boundary prescribes the motion of node 0 at (-0.02, 0.001) m, as the one in line 27 does"]),
    ("boundary of a node twice", BASE + "&boundary where = 'list', nodes = 3, 3 /\n",
     ["27:27 'nodes' in &boundary has node 3 twice"]),
    ("traction on a node", BASE + "&boundary where = 'box', box = -0.001, -0.001, 0.001, 0.001, kind = 'traction', "
     "traction = 0, 1 /\n",
     ["27:11 &boundary chooses no edge of body 1 for its traction: both nodes of one must be chosen"]),
    ("damping_time negative", edit(BASE, "thickness = 1 -> damping_time = -1e-6"),
     ["9:20 'damping_time' in &material must be >= 0, got -1e-6"]),
    ("mass_damping negative", BASE + "&solver mass_damping = -1 /\n",
     ["27:24 'mass_damping' in &solver must be >= 0, got -1"]),
    ("window negative", BASE + "&contact window = -1 /\n",
     ["27:19 'window' in &contact must be >= 0, got -1"]),
    ("number for a logical", BASE + "&contact vertices = 1 /\n",
     ["27:21 'vertices' in &contact expects a logical, got '1'"]),
    ("thickness without contact of bodies", BASE + "&contact bodies = 'none', thickness = 1e-4, stiffness = 2 /\n",
     ["27:27 'thickness' in &contact is not used by bodies 'none'", "27:45 'stiffness' in &contact is not used by bodies 'none'"]),
    ("friction without contact of bodies", edit(BASE, "thickness = 1 -> friction = 0.3") + "&contact bodies = 'none', friction = 0.2 /\n",
     ["9:5 'friction' in &material is not used by bodies 'none' in &contact",
      "27:27 'friction' in &contact is not used by bodies 'none'"]),
    ("friction of bodies negative", edit(BASE, "thickness = 1 -> friction = -0.3") + "&contact bodies = 'all', friction = -0.1 /\n",
     ["9:16 'friction' in &material must be >= 0, got -0.3", "27:37 'friction' in &contact must be >= 0, got -0.1"]),
    ("bodies that cross", edit(BASE, "&output -> &body shape = 'rectangle', size = 0.04, 0.05, spacing = 0.01, position = 0.003, "
                               "0.04, material = 'rubber' /\n&contact bodies = 'others' /\n&output"),
     ["24:10 node 26 of body 1 at (0.02, 0.0429996) m is 0.00299956 m inside body 2, behind its edge between nodes 35 and 36: surfaces "
      "must not cross at the start; bodies = 'none' in &contact lets bodies overlap"]),
    ("bodies with friction that cross", edit(BASE, "thickness = 1 -> friction = 0.3", "&output -> &body shape = "
                                             "'rectangle', size = 0.04, 0.05, spacing = 0.01, position = 0.003, 0.04, "
                                             "material = 'rubber' /\n&contact bodies = 'others' /\n&output"),
     ["24:10 node 26 of body 1 at (0.02, 0.0429996) m is 0.00299956 m inside body 2, behind its edge between nodes 35 and 36: surfaces "
      "must not cross at the start; bodies = 'none' in &contact lets bodies overlap"]),
    ("guide of a body that is not rigid", edit(BASE, "velocity = 0, -1 -> guide = 'x'"),
     ["17:5 'guide' in &body is not used without 'rigid'"]),
    ("guide unknown", edit(BASE, "velocity = 0, -1 -> rigid = .true., guide = 'z'") + "&solver max_step = 1e-4 /\n",
     ["17:29 'guide' in &body must be 'none', 'x' or 'y', got 'z' (did you mean 'x'?)"]),
    ("motion off the guide", edit(BASE, "velocity = 0, -1 -> rigid = .true., guide = 'x', velocity = 0, -1, spin = 2")
     + "&solver max_step = 1e-4 /\n",
     ["17:34 'velocity' in &body must be along its guide, 'x', got 0, -1", "17:52 'spin' in &body does not go with 'guide', got 2"]),
    ("rigid without contact of bodies", edit(BASE, "velocity = 0, -1 -> rigid = .true.")
     + "&solver max_step = 1e-4 /\n&contact bodies = 'none' /\n",
     ["17:5 'rigid' in &body needs contact of bodies, but 'bodies' in &contact is 'none'"]),
    ("rigid and held", edit(BASE, "velocity = 0, -1 -> rigid = .true.")
     + "&solver max_step = 1e-4 /\n&boundary where = 'side', side = 'top' /\n",
     ["28:1 &boundary of kind 'fix' is for body 1, which is rigid; 'guide' in &body says how it may move"]),
    ("rigid bodies alone", edit(BASE, "velocity = 0, -1 -> rigid = .true."),
     ["17:5 'rigid' in &body: all bodies are rigid, so that 'max_step' or 'fixed_step' in &solver must be given"]),
    ("rigid body inside an obstacle", edit(BASE, "velocity = 0, -1 -> rigid = .true.", "0, 0.001 -> 0, -0.01")
     + "&solver max_step = 1e-4 /\n",
     ["11:1 body 1 starts 0.01 m inside obstacle 1, at (-0.02, -0.01) m, deeper than the penetration tolerance of 7.94878e-09 m; "
      "'position' or 'clearance' can put it in front, or reverse the obstacle's points: bodies live on the left of each segment"]),
    ("rigid body too near to an obstacle", edit(BASE, "velocity = 0, -1 -> rigid = .true.", "0, 0.001 -> 0, 1e-9")
     + "&solver max_step = 1e-4 /\n",
     ["1:1 body 1, which is rigid, is 1e-09 m from obstacle 1 at (-0.02, 1e-09) m: they must be 9e-05 m apart at the start, a "
      "twentieth of the contact thickness"]),
    ("stiffness of surfaces too large", BASE + "&contact bodies = 'all', stiffness = 101 /\n",
     ["27:38 'stiffness' in &contact must be in [0.01, 100], got 101"]),
    ("contact of bodies unknown", BASE + "&contact bodies = 'some' /\n",
     ["27:19 'bodies' in &contact must be 'none', 'others' or 'all', got 'some' (did you mean 'none'?)"]),
    ("method of contact unknown", BASE + "&contact method = 'rooted' /\n",
     ["27:19 'method' in &contact must be 'local' or 'exact', got 'rooted'"]),
    ("rtol 0", BASE + "&solver rtol = 0 /\n",
     ["27:16 'rtol' in &solver must be in [1e-13, 1e-1], got 0"]),
    ("rtol too large", BASE + "&solver rtol = 0.5 /\n",
     ["27:16 'rtol' in &solver must be in [1e-13, 1e-1], got 0.5"]),
    ("max_step 0", BASE + "&solver max_step = 0 /\n",
     ["27:20 'max_step' in &solver must be > 0, got 0"]),
    ("penetration tolerance 0", BASE + "&contact penetration_tolerance = 0 /\n",
     ["27:34 'penetration_tolerance' in &contact must be > 0, got 0"]),
    ("max_impacts 0", BASE + "&contact max_impacts = 0 /\n",
     ["27:24 'max_impacts' in &contact must be >= 1, got 0"]),
    ("deflate too large", edit(BASE, "frame_interval = 1e-4 -> deflate = 10"),
     ["25:15 'deflate' in &output must be in [0, 9], got 10"]),
    ("choice misspelt", edit(BASE, "'rectangle' -> 'rectangel'"),
     ["12:13 'shape' in &body must be 'rectangle', 'disc', 'ring', 'polygon', 'mask', 'mesh' or 'file', got "
      "'rectangel' (did you mean 'rectangle'?)"]),
    ("choice like no other", edit(BASE, "'rectangle' -> 'banana'"),
     ["12:13 'shape' in &body must be 'rectangle', 'disc', 'ring', 'polygon', 'mask', 'mesh' or 'file', got 'banana'"]),
    ("method with its orders swapped", BASE + "&solver method = 'dopri54' /\n",
     ["27:18 'method' in &solver must be 'fehlberg45', 'dopri45', 'cashkarp45', 'zonneveld34', 'bs23', 'heun12', "
      "'sayfyaburub34', 'ark23', 'ark34', 'ark34b', 'ark45', 'ark45b', 'verner56', 'verner67', 'verner78', 'verner89', "
      "'fehlberg78', 'knothwolke3', 'rk4' or 'verlet', got 'dopri54' (did you mean 'dopri45'?)"]),
    ("two lengths of steps", BASE + "&solver max_step = 1e-5, fixed_step = 1e-6 /\n",
     ["27:9 'max_step' in &solver: give it or 'fixed_step', not both"]),
    ("name of the output with a folder", edit(BASE, "'block' -> 'results/block'"),
     ["24:5 'name' in &output must have 1 to 100 characters, no '/', and not begin with '.' or '-'"]),
    ("name of the output empty", edit(BASE, "'block' -> ''"),
     ["24:5 'name' in &output must have 1 to 100 characters, no '/', and not begin with '.' or '-'"]),
    ("name of the output like that of its obstacles", edit(BASE, "'block' -> 'block.obstacle'"),
     ["24:5 'name' in &output must not end in '.obstacle', '.body', '.part' or a '.' and five digits or more: other files are called so"]),
    ("name of the output like that of its part", edit(BASE, "'block' -> 'block.part'"),
     ["24:5 'name' in &output must not end in '.obstacle', '.body', '.part' or a '.' and five digits or more: other files are called so"]),
    ("too many frames", edit(BASE, "1e-4 -> 1e-12"),
     ["25:5 'frame_interval' in &output, 1e-12 s, makes 1e+09 frames until 't_end'; the limit is 10000000"]),
    ("too many frames of the default interval",
     without(edit(BASE, "t_end = 1e-3 -> t_end = 1e9"), "    frame_interval = 1e-4\n"),
     ["23:1 'frame_interval' in &output, 0.001 s, makes 1e+12 frames until 't_end'; the limit is 10000000"]),
    ("penetration tolerance that rounding hides", jagged(BASE + "&contact penetration_tolerance = 1e-300 /\n"),
     ["27:10 'penetration_tolerance' in &contact must be >= 1.2e-15 m, or rounding of coordinates of up to 0.0529615 m hides it, got "
      "1e-300 m"]),
    ("spacing for the error that rounding hides", jagged(BASE + "&solver spacing = 1e-20 /\n"),
     ["27:9 'rtol' in &solver, 1e-06 of a spacing of 1e-20 m, asks for less than rounding makes of coordinates of up to "
      "0.0529615 m"]),
    ("scale of speed that rounding hides", BASE + "&solver v_scale = 1e-15 /\n",
     ["27:9 'rtol' in &solver, 1e-06 of 'v_scale', 1e-15 m/s, asks for less than rounding makes of velocities of up to "
      "1 m/s"]),
    ("rest_speed 0", BASE + "&contact rest_speed = 0 /\n",
     ["27:23 'rest_speed' in &contact must be > 0, got 0"]),
    ("v_scale negative", BASE + "&solver v_scale = -1 /\n",
     ["27:19 'v_scale' in &solver must be > 0, got -1"]),
    ("fixed_step 0", BASE + "&solver fixed_step = 0 /\n",
     ["27:22 'fixed_step' in &solver must be > 0, got 0"]),
    ("no thread", BASE + "&solver threads = 0 /\n",
     ["27:19 'threads' in &solver must be in [1, 1024], got 0"]),
    ("kernel unknown", BASE + "&solver kernel = 'sse' /\n",
     ["27:18 'kernel' in &solver must be 'auto', 'portable', 'avx2' or 'avx512', got 'sse'"]),
    ("residual too large", edit(BASE, "t_end = 1e-3 -> t_end = 1e-3, residual = 1"),
     ["2:30 'residual' in &run must be in [1e-12, 0.1], got 1"]),
    ("pause without residual", edit(BASE, "t_end = 1e-3 -> t_end = 1e-3, pause = .true."),
     ["2:19 'pause' in &run needs 'residual', at which a pause ends"]),
    ("probe of nothing", BASE + "&probe name = 'tip' /\n",
     ["27:1 &probe needs 'place' or 'number'"]),
    ("two probes of one name", BASE + 2 * "&probe name = 'tip', number = 1 /\n",
     ["28:8 two probes have the name 'tip', the first in line 27"]),
    ("name of the output hidden", edit(BASE, "'block' -> '.block'"),
     ["24:5 'name' in &output must have 1 to 100 characters, no '/', and not begin with '.' or '-'"]),
    ("string of 5000 characters", edit(BASE, "1e-3 -> 1e-3, title = '" + 5000 * "t" + "'"),
     ["2:27 the string is longer than 4096 bytes"]),
    # counts
    ("too few coordinates", edit(BASE, "-0.1, 0, 0.1, 0 -> -0.1, 0"),
     ["20:5 'points' in &obstacle expects at least 4 values, got 2"]),
    ("odd number of coordinates", edit(BASE, "-0.1, 0, 0.1, 0 -> -0.1, 0, 0.1, 0, 0.2"),
     ["20:5 'points' in &obstacle must be pairs of x and y, got 5 values"]),
    ("degenerate segment", edit(BASE, "-0.1, 0, 0.1, 0 -> -0.1, 0, 0.1, 0, 0.1, 0, 0.2, 0"),
     ["20:5 'points' in &obstacle: segment 2 of obstacle 1, from (0.1, 0) to (0.1, 0) m, has no length"]),
    ("many degenerate segments", edit(BASE, "-0.1, 0, 0.1, 0 -> 2*0, 1, 9*0"),
     ["20:5 'points' in &obstacle: segment 3 of obstacle 1, from (0, 0) to (0, 0) m, has no length; so it is with "
      "3 of 5 segments"]),
    ("segment too short", edit(BASE, "-0.1, 0, 0.1, 0 -> 0, 0, 1e-200, 0"),
     ["20:5 'points' in &obstacle: segment 1 of obstacle 1, from (0, 0) to (1e-200, 0) m, is too short"]),
    ("obstacle that crosses itself", edit(BASE, "-0.1, 0, 0.1, 0 -> -0.1,0, 0.1,0, 0.1,-0.1, 0,0.1"),
     ["20:5 'points' in &obstacle: segment 1 of obstacle 1 meets segment 3"]),
    ("obstacle that touches itself", edit(BASE, "-0.1, 0, 0.1, 0 -> -0.1,0, 0.1,0, 0.1,-0.1, 0,0, -0.1,-0.1"),
     ["20:5 'points' in &obstacle: segment 1 of obstacle 1 meets segment 3"]),
    ("obstacle that goes back", edit(BASE, "-0.1, 0, 0.1, 0 -> -0.1,0, 0.1,0, 0,0"),
     ["20:5 'points' in &obstacle: segment 2 of obstacle 1 goes back over segment 1"]),
    ("closed obstacle that goes back", BASE + "&obstacle points = 0,-9, 1,-9, 2,-8, 2,-9, 0,-9 /\n",
     ["27:11 'points' in &obstacle: segment 2 of obstacle 2 meets segment 4"]),
    ("two obstacles that cross themselves",
     edit(BASE, "-0.1, 0, 0.1, 0 -> -0.1,0, 0.1,0, 0.1,-0.1, 0,0.1") + "&obstacle points = 0,-9, 1,-9, 0,-9 /\n",
     ["20:5 'points' in &obstacle: segment 1 of obstacle 1 meets segment 3",
      "27:11 'points' in &obstacle: segment 2 of obstacle 2 goes back over segment 1"]),
    ("profile unknown", edit(BASE, "restitution = 0.5 -> profile = 'spline'"),
     ["21:15 'profile' in &obstacle must be 'polyline', 'smooth' or 'rough', got 'spline'"]),
    ("profile that runs back", edit(BASE, "0.1, 0\n    restitution = 0.5 -> 0.1, 0, 0, 1\n    profile = 'smooth'"),
     ["20:5 'points' in &obstacle must increase in x for profile 'smooth'; point 3 of obstacle 1 is at 0 m, the one "
      "before at 0.1 m"]),
    ("profile that stands upright", edit(BASE, "-0.1, 0, 0.1, 0\n    restitution = 0.5 -> 0, 0, 0, 1\n    " + ROUGH),
     ["20:5 'points' in &obstacle must increase in x for profile 'rough'; point 2 of obstacle 1 is at 0 m, the one "
      "before at 0 m"]),
    ("resolution coarser than the profile", edit(BASE, "restitution = 0.5 -> profile = 'smooth', resolution = 0.3"),
     ["21:25 'resolution' in &obstacle must not exceed the extent of its points, 0.2 m, got 0.3 m"]),
    ("too many segments", edit(BASE, "restitution = 0.5 -> profile = 'smooth', resolution = 1e-9"),
     ["21:25 'resolution' in &obstacle, 1e-09 m, makes 2e+08 segments of obstacle 1; the limit is 100000"]),
    ("resolution 0", edit(BASE, "restitution = 0.5 -> profile = 'smooth', resolution = 0"),
     ["21:38 'resolution' in &obstacle must be > 0, got 0"]),
    ("profile far away",
     edit(BASE, "-0.1, 0, 0.1, 0 -> 1e8, 0, 100000000.2, 0", "restitution = 0.5 -> profile = 'smooth'"),
     ["19:1 obstacle 1 has points at x of up to 1e+08 m, so large that rounding blurs its segments of 0.001 m"]),
    ("resolution coarser than the correlation", edit(BASE, f"restitution = 0.5 -> {ROUGH}, resolution = 0.006"),
     ["21:62 'resolution' in &obstacle must be 1/500 to 1/2 of 'correlation', 0.01 m, got 0.006 m"]),
    ("default resolution finer than the correlation", edit(BASE, f"restitution = 0.5 -> {ROUGH[:-4]}2"),
     ["19:1 'resolution' in &obstacle must be 1/500 to 1/2 of 'correlation', 2 m, got 0.001 m, the default"]),
    ("roughness negative", edit(BASE, "restitution = 0.5 -> profile = 'rough', roughness = -1, correlation = 0.01"),
     ["21:36 'roughness' in &obstacle must be >= 0, got -1"]),
    ("correlation 0", edit(BASE, "restitution = 0.5 -> profile = 'rough', roughness = 1, correlation = 0"),
     ["21:53 'correlation' in &obstacle must be > 0, got 0"]),
    ("seed too large for the generator", edit(BASE, f"restitution = 0.5 -> {ROUGH}, seed = 4294967296"),
     ["21:69 'seed' in &obstacle must be in [0, 4294967295], got 4294967296"]),
    ("keys missing for a rough profile", edit(BASE, "restitution = 0.5 -> profile = 'rough'"),
     ["19:1 'roughness' in &obstacle must be given for profile 'rough'",
      "19:1 'correlation' in &obstacle must be given for profile 'rough'"]),
    ("keys of a rough profile for a smooth one",
     edit(BASE, f"restitution = 0.5 -> {ROUGH.replace('rough', 'smooth', 1)}"),
     ["21:25 'roughness' in &obstacle is not used by profile 'smooth'",
      "21:43 'correlation' in &obstacle is not used by profile 'smooth'"]),
    ("keys of profiles for a polyline", edit(BASE, "restitution = 0.5 -> resolution = 0.01, seed = 3"),
     ["21:5 'resolution' in &obstacle is not used by profile 'polyline'",
      "21:24 'seed' in &obstacle is not used by profile 'polyline'"]),
    ("rough profile too high to compute with",
     edit(BASE, "restitution = 0.5 -> profile = 'rough', roughness = 1e200, correlation = 0.4, resolution = 0.2,\n"
          "    seed = 5489"),
     ["20:5 'points' in &obstacle: segment 1 of obstacle 1, from (-0.1, -7.20663e+199) to (0.1, -1.90369e+199) m, is "
      "too long"]),
    ("too many values", edit(BASE, "0, -9.81 -> 0, -9.81, 0"),
     ["3:5 'gravity' in &run expects 2 values, got 3"]),
    ("too few values", edit(BASE, "0.04, 0.05 -> 0.04"),
     ["13:5 'size' in &body expects 2 values, got 1"]),
    ("decimal comma", edit(DISC, "radius = 0.03 -> radius = 0,03"),
     ["13:5 'radius' in &body expects 1 value, got 2; a decimal point is written '.', not ','"]),
    ("decimal comma in one of two", edit(BASE, "0, -9.81 -> 0, -9,81"),
     ["3:5 'gravity' in &run expects 2 values, got 3; a decimal point is written '.', not ','"]),
    ("count before range", edit(BASE, "= 0.5 -> = 2, 0.5"),
     ["21:5 'restitution' in &obstacle expects 1 value, got 2"]),
    ("two words without quotes", edit(BASE, "'block' -> my block"),
     ["24:12 'name' in &output expects a string in quotes, got my",
      "24:15 'name' in &output expects a string in quotes, got block"]),
    ("two values for one", edit(BASE, "1050 -> 1050, 1060"),
     ["8:5 'density' in &material expects 1 value, got 2"]),
    ("repeat count absurd", edit(BASE, "-0.1, 0, 0.1, 0 -> 99999999999999999999*0"),
     ["20:14 repeat count '99999999999999999999' is not in 1 to 100000"]),
    ("repeat count 0", edit(BASE, "-0.1, 0, 0.1, 0 -> 0*1"),
     ["20:14 repeat count '0' is not in 1 to 100000"]),
    ("repeated fault reported once", edit(BASE, "-0.1, 0, 0.1, 0 -> 8*1e999"),
     ["20:14 'points': '1e999' is too large for a real"]),
    ("hole between subscripts", edit(BASE, "points = -0.1, 0, 0.1, 0 -> points(1) = -0.1, 0, points(4) = 1"),
     ["20:5 'points(3)' in &obstacle is not given"]),
    ("hole before a subscript", edit(BASE, "size = 0.04, 0.05 -> size(2) = 0.05"),
     ["13:5 'size(1)' in &body is not given"]),
    ("two subscripts", BASE + "&contact penetration_tolerance(1,1) = 1e-8 /\n",
     ["27:10 'penetration_tolerance' has more than one subscript; only one is understood"]),
    ("subscript 0", BASE + "&contact penetration_tolerance(0) = 1e-8 /\n",
     ["27:10 the subscript of 'penetration_tolerance' must ascend, from 1 to 100000 at most"]),
    ("subscript absurd", BASE + "&contact penetration_tolerance(1000000) = 1e-8 /\n",
     ["27:10 the subscript of 'penetration_tolerance' must ascend, from 1 to 100000 at most"]),
    ("subscript given twice", edit(BASE, "size = 0.04, 0.05 -> size(1) = 0.05, size(1:2) = 0.04, 0.05"),
     ["13:21 'size(1)' is given twice in &body, first in line 13"]),
    ("more values than the subscript takes", BASE + "&solver rtol(1:1) = 1e-6, 1e-7 /\n",
     ["27:9 the subscript of 'rtol' has room for 1, got 2 values"]),
    # syntax
    ("string not closed", edit(BASE, "'block' -> 'block"),
     ["24:12 the string is not closed"]),
    ("group not closed before the next", edit(BASE, "thickness = 1\n/ -> thickness = 1"),
     ["5:1 &material is not closed: '/' is missing before &body in line 10"]),
    ("group not closed at the end", edit(BASE, "1e-4\n/ -> 1e-4"),
     ["23:1 &output is not closed: '/' is missing before the end of the file"]),
    ("group closed twice", BASE + "&end\n",
     ["27:1 '&end' closes no group"]),
    ("key without a value", edit(BASE, "1050 -> "),
     ["5:1 'density' in &material must be given"]),
    ("equal sign missing", edit(BASE, "t_end = 1e-3 -> t_end 1e-3"),
     ["2:5 '=' is missing after 't_end'"]),
    ("semicolon", edit(BASE, "0, -9.81 -> 0; -9.81"),
     ["3:16 values are separated by ',' or blanks, not by ';'"]),
    ("comment with a hash", edit(BASE, "-9.81 -> -9.81 # down"),
     ["3:24 unexpected '#'; comments begin with '!'"]),
    ("embedded NUL", edit(BASE, "1050 -> 1050\0"),
     ["8:19 byte 0x00 is not text; UTF-8 is expected"]),
    ("not UTF-8", edit(BASE, "1e-3 -> 1e-3, title = 'Größe'").encode("latin-1"),
     ["2:30 byte 0xF6 is not text; UTF-8 is expected"]),
    ("not UTF-8 in many lines", edit(BASE, "1e-3 -> 1e-3 ! Größe", "1050 -> x ! Größe").encode("latin-1"),
     ["2:22 byte 0xF6 is not text; UTF-8 is expected (2 such lines)"]),
    ("UTF-16 with its mark", BASE.encode("utf-16"),
     ["1:1 the file is in UTF-16; UTF-8 is expected"]),
    ("UTF-16 without its mark", BASE.encode("utf-16-le"),
     ["1:1 the file is in UTF-16; UTF-8 is expected"]),
    ("ends of lines of old Macs", BASE.replace("\n", "\r"),
     ["1:5 byte 0x0D is not text; UTF-8 is expected"]),
    ("line longer than 64 KiB", BASE + "!" + 2**16 * "x" + "\n",
     ["27:65537 the line is longer than 65536 characters"]),
    ("empty file", b"",
     ["- the file is empty"]),
    ("file larger than 4 MiB", "!" * 2**22 + "\n" + BASE,
     ["- the file is larger than 4 MiB"]),
    # keys that do not go together
    ("key not used by the shape", edit(BASE, "spacing = 0.01 -> spacing = 0.01\n    radius = 0.02"),
     ["15:5 'radius' in &body is not used by shape 'rectangle'"]),
    ("E, nu and plane of equal springs", edit(BASE, "= 1050 -> = 1050\n    bond_stiffness = 1, plane = 'strain', poissons_ratio = 0.2"),
     ["7:5 'youngs_modulus' in &material does not go with 'bond_stiffness'",
      "9:25 'plane' in &material does not go with 'bond_stiffness'",
      "9:43 'poissons_ratio' in &material does not go with 'bond_stiffness'"]),
    ("diagonals of equal springs", edit(BASE, "youngs_modulus -> bond_stiffness", "= 0.01 -> = 0.01, lattice = 'square', diagonal = 1"),
     ["14:41 'diagonal' in &body is not used with the 'bond_stiffness' of its material"]),
    ("bond_stiffness", edit(BASE, "youngs_modulus = 1e7 -> bond_stiffness = 0"),
     ["7:22 'bond_stiffness' in &material must be > 0, got 0"]),
    ("diagonal of triangles", edit(BASE, "= 0.01 -> = 0.01, diagonal = 0.3"),
     ["14:21 'diagonal' in &body is not used by lattice 'triangular'"]),
    ("diagonal", edit(BASE, "= 0.01 -> = 0.01, lattice = 'square', diagonal = 0"),
     ["14:52 'diagonal' in &body must be > 0, got 0"]),
    ("squares that warp", edit(BASE, "= 0.01 -> = 0.01, lattice = 'square', diagonal = 1"),
     ["14:41 body 1: the stiffness of a diagonal over a side's must be less than 1, or cells warp, at Poisson's ratio "
      "0.333333 in plane stress: 1"]),
    ("jitter", edit(BASE, "= 0.01 -> = 0.01, jitter = 0.31"),
     ["14:30 'jitter' in &body must be in [0, 0.3], got 0.31"]),
    ("seed without jitter", edit(BASE, "= 0.01 -> = 0.01, seed = 3"),
     ["14:21 'seed' in &body is not used without 'jitter' or 'scatter'"]),
    ("jitter of a mesh", edit(MESH, "scale = 0.01 -> scale = 0.01, jitter = 0.1"),
     ["13:38 'jitter' in &body is not used by shape 'mesh'"]),
    ("keys not used by a lattice file", edit(BASE, "'rectangle' -> 'file'"),
     ["11:1 'file' in &body must be given for shape 'file'",
      "13:5 'size' in &body is not used by shape 'file'",
      "14:5 'spacing' in &body is not used by shape 'file'",
      "15:5 'material' in &body is not used by shape 'file'"]),
    ("key missing for the shape", edit(BASE, "'rectangle' -> 'disc'"),
     ["11:1 'radius' in &body must be given for shape 'disc'",
      "13:5 'size' in &body is not used by shape 'disc'"]),
    ("key missing for the shape of a void", BASE + "&void shape = 'rectangle', centre = 0, 0.02, radius = 0.01 /\n",
     ["27:1 'size' in &void must be given for shape 'rectangle'",
      "27:46 'radius' in &void is not used by shape 'rectangle'"]),
    ("misspelt and therefore missing", edit(BASE, "size = -> siez =", "spacing -> spacng"),
     ["13:5 unknown key 'siez' in &body (did you mean 'size'?)",
      "14:5 unknown key 'spacng' in &body (did you mean 'spacing'?)"]),
    ("subscript at fault and therefore missing", edit(BASE, "size = 0.04, 0.05 -> size(0) = 0.04"),
     ["13:5 the subscript of 'size' must ascend, from 1 to 100000 at most"]),
    ("name of the material at fault", edit(BASE, "name = 'rubber' -> name = rubber"),
     ["6:12 'name' in &material expects a string in quotes, got rubber"]),
    ("group of the material misspelt", edit(BASE, "&material -> &matrial"),
     ["5:1 unknown group &matrial (did you mean &material?)"]),
    ("no material at all", BASE[:BASE.index("&material")] + BASE[BASE.index("&body"):],
     ["1:1 &material must be given"]),
    ("lattice file without a name", edit(FILE, "part.h5 -> "),
     ["13:5 'file' in &body must name a lattice file, got ''"]),
    ("unknown material", edit(BASE, "material = 'rubber' -> material = 'ruber'"),
     ["15:5 there is no material 'ruber' (did you mean 'rubber'?)"]),
    ("unknown material like no other", edit(BASE, "material = 'rubber' -> material = 'steel'"),
     ["15:5 there is no material 'steel'; known: 'rubber'"]),
    ("material not named", without(BASE, "    material = 'rubber'\n"),
     ["11:1 there is no material 'solid', the default of 'material' in &body; known: 'rubber'"]),
    ("two materials of one name", BASE + "&material name = 'rubber', youngs_modulus = 1, density = 1 /\n",
     ["27:11 material 'rubber' is given twice, first in line 5"]),
    ("void of a body that does not exist", BASE + "&void body = 2, centre = 0, 0.02, radius = 0.005 /\n",
     ["27:7 &void is for body 2, but the number of bodies is 1"]),
    ("void of body 0", BASE + "&void body = 0, centre = 0, 0.02, radius = 0.005 /\n",
     ["27:14 'body' in &void must be >= 1, got 0"]),
    ("void of a lattice file", FILE + "&void centre = 0, 0.02, radius = 0.005 /\n",
     ["25:1 &void is for body 1, which is of shape 'file'"]),
    ("pores of a body that does not exist", BASE + "&pores body = 3, number = 1, radius = 5e-3, 6e-3 /\n",
     ["27:8 &pores is for body 3, but the number of bodies is 1"]),
    ("pores with radii swapped", BASE + "&pores number = 1, radius = 6e-3, 5e-3 /\n",
     ["27:20 'radius' in &pores must be the smallest, then the largest one, got 0.006, 0.005"]),
    ("too many pores", BASE + "&pores number = 10001, radius = 5e-3, 6e-3 /\n",
     ["27:8 'number' in &pores must be at most 10000, got 10001"]),
    ("spacing larger than the rectangle", edit(BASE, "0.01\n -> 0.1\n"),
     ["14:5 'spacing' in &body must not exceed the size, 0.04 m x 0.05 m, got 0.1 m"]),
    ("spacing larger than the disc", edit(DISC, "0.01\n -> 0.1\n"),
     ["14:5 'spacing' in &body must not exceed the radius, 0.03 m, got 0.1 m"]),
    ("clearance without an obstacle", without(edit(BASE, "position = 0, 0.001 -> clearance = 1e-3"), OBSTACLE),
     ["16:5 'clearance' in &body needs an &obstacle"]),
    ("clearance without gravity", edit(BASE, "position = 0, 0.001 -> clearance = 1e-3", "-9.81 -> 0"),
     ["16:5 'clearance' in &body needs gravity, which is 0"]),
]


class Refused(refusal.Refusal):
    # ---- decks

    def test_the_base_deck_is_good(self):
        self.put(BASE)
        code, _, stderr, _ = self.run_program("--check", "deck.nml")
        self.assertEqual((code, stderr), (0, ""))

    def test_decks(self):
        self.refuse_all(DECKS)

    def test_messages_have_a_limit(self):
        self.put(BASE + 1500 * "&weather /\n")
        lines = [f"{27 + k}:1 unknown group &weather" for k in range(999)]
        self.refuse(3, stderr_of(lines + ["1026:1 too many errors"]), "deck.nml")

    def test_methods_that_sundials_lacks(self):
        _, version, _, _ = self.run_program("--version")
        version = version.decode().split("SUNDIALS ")[1].split(",")[0]
        if tuple(map(int, version.split(".")[:2])) >= (6, 7):
            return
        self.put(BASE + "&solver method = 'verner89' /\n")
        reason = f"27:9 method 'verner89' needs SUNDIALS 6.7 or later, this is {version}"
        self.refuse(3, stderr_of([reason]), "--check", "deck.nml")

    # ---- files

    def test_deck_missing(self):
        self.refuse(3, "deck.nml: error: No such file or directory\n", "deck.nml")
        self.refuse(3, "no/deck.nml: error: No such file or directory\n", "no/deck.nml")

    def test_deck_is_a_folder(self):
        self.refuse(3, "out: error: not a regular file\n", "out")

    def test_deck_is_a_pipe_that_nobody_writes_to(self):
        os.mkfifo(self.folder / "pipe")
        self.refuse(3, "pipe: error: not a regular file\n", "pipe")

    def test_deck_is_a_device(self):
        self.refuse(3, "/dev/null: error: not a regular file\n", "/dev/null")
        self.refuse(3, "/dev/zero: error: not a regular file\n", "/dev/zero")

    def test_deck_may_not_be_read(self):
        self.put(BASE)
        (self.folder / "deck.nml").chmod(0)
        if os.geteuid() != 0:  # root reads everything
            self.refuse(3, "deck.nml: error: Permission denied\n", "deck.nml")

    def test_lattice_file_is_looked_for_beside_the_deck(self):
        (self.folder / "out" / "deck.nml").write_text(FILE, encoding="utf-8")
        self.refuse(3, "out/deck.nml:13:5: error: body 1: out/part.h5: cannot be opened (No such file or directory)\n",
                    "out/deck.nml")

    # ---- command lines

    def test_no_deck(self):
        self.refuse_usage("no deck")
        self.refuse_usage("no deck", "--check")
        self.refuse_usage("no deck", "--echo")
        self.refuse_usage("no deck", "--outdir", "out")

    def test_settings_that_are_none(self):
        self.put(BASE)
        self.refuse_usage("'--set' needs group.key=value or group(k).key=value", "deck.nml", "--set")
        for text in ("", "run", "run.t_end", "t_end=1", ".t_end=1", "run.=1", "run t_end=1", "run.t_end(1)=1", "run(0).t_end=1",
                     "run().t_end=1", "run(1.t_end=1", "run(1234567).t_end=1", "9run.t_end=1", "run. t_end=1", "x" * 64 + ".t_end=1"):
            with self.subTest(text):
                self.refuse_usage(f"'--set' needs group.key=value or group(k).key=value, got {text}", "deck.nml", "--set", text)

    def test_an_index_that_is_none(self):
        self.put(BASE)
        self.refuse_usage("'--index' needs the number of a deck, from 1", "deck.nml", "--index")
        for text in ("", "0", "-1", "1.5", "one", "1000000000000"):
            with self.subTest(text):
                self.refuse_usage(f"'--index' needs the number of a deck, from 1, got {text}", "deck.nml", "--index", text)

    def test_two_actions(self):
        self.put(BASE)
        self.refuse_usage("'--echo' does not go with '--check'", "--check", "--echo", "deck.nml")
        self.refuse_usage("'--help' does not go with '--echo'", "--echo", "deck.nml", "--help")
        self.refuse_usage("'--check' does not go with '--check'", "--check", "--check", "deck.nml")

    def test_unknown_option(self):
        self.put(BASE)
        for option in ("--frames", "-c", "-", "--check=yes", "--outdir=out"):
            with self.subTest(option):
                self.refuse_usage(f"'{option}' is no option", option, "deck.nml")

    def test_outdir_without_a_folder(self):
        self.put(BASE)
        self.refuse_usage("'--outdir' needs a folder", "deck.nml", "--outdir")
        self.refuse_usage("'--outdir' needs a folder", "--outdir", "", "deck.nml")

    def test_a_deck_where_none_belongs(self):
        self.put(BASE)
        for option in ("--template", "--keys", "--version", "--help"):
            with self.subTest(option):
                self.refuse_usage(f"'{option}' takes no deck, got 'deck.nml'", option, "deck.nml")


if __name__ == "__main__":
    refusal.main()
