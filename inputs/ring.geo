// The ring of ring_mesh.nml, in mm. Gmsh makes ring.msh from it, or a finer mesh by another spacing:
//     gmsh -2 -format msh41 -setnumber spacing 2 ring.geo -o ring.msh
DefineConstant[ spacing = 2 ];
Point(1) = {0, 0, 0};
For k In {0:3}
  Point(2 + k) = {50 * Cos(k * Pi / 2), 50 * Sin(k * Pi / 2), 0, spacing};
  Point(6 + k) = {40 * Cos(k * Pi / 2), 40 * Sin(k * Pi / 2), 0, spacing};
EndFor
For k In {0:3}
  Circle(1 + k) = {2 + k, 1, 2 + (k + 1) % 4};
  Circle(5 + k) = {6 + k, 1, 6 + (k + 1) % 4};
EndFor
Curve Loop(1) = {1:4};
Curve Loop(2) = {5:8};
Plane Surface(1) = {1, 2};
