// A quarter of the plate of kirsch.nml, 400 x 200 mm with a hole of radius 10 mm, in mm. Gmsh makes kirsch.msh from it;
// another `fine` gives other triangles at the hole:
//     gmsh -2 -format msh41 -setnumber fine 1 kirsch.geo -o kirsch.msh
DefineConstant[ fine = 1, growth = 0.15, coarse = 8 ];
Point(1) = {0, 0, 0};
Point(2) = {10, 0, 0};
Point(3) = {200, 0, 0};
Point(4) = {200, 100, 0};
Point(5) = {0, 100, 0};
Point(6) = {0, 10, 0};
Line(1) = {2, 3};
Line(2) = {3, 4};
Line(3) = {4, 5};
Line(4) = {5, 6};
Circle(5) = {6, 1, 2};
Curve Loop(1) = {1:5};
Plane Surface(1) = {1};
// The size of a triangle grows with the distance from the hole.
Field[1] = MathEval;
Field[1].F = Sprintf("min(%g, %g + %g * (Sqrt(x*x + y*y) - 10))", coarse, fine, growth);
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
