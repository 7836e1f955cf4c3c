// A square sheet of 500 mm with a hole of radius 80 mm in its middle, for Gmsh:
//
//   gmsh -2 sheet-hole.geo -format msh41 -o sheet-hole.msh        (the file here was written by Gmsh 4.8.4)
//
// Where there are physical groups, Gmsh saves their elements only: the sheet needs one too.

side = 500; radius = 80; size = 14;

Point(1) = {-side/2, -side/2, 0, size};
Point(2) = {side/2, -side/2, 0, size};
Point(3) = {side/2, side/2, 0, size};
Point(4) = {-side/2, side/2, 0, size};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};

Point(5) = {0, 0, 0, size};
Point(6) = {radius, 0, 0, size};
Point(7) = {0, radius, 0, size};
Point(8) = {-radius, 0, 0, size};
Point(9) = {0, -radius, 0, size};
Circle(5) = {6, 5, 7};
Circle(6) = {7, 5, 8};
Circle(7) = {8, 5, 9};
Circle(8) = {9, 5, 6};

Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {5, 6, 7, 8};
Plane Surface(1) = {1, 2};

Physical Surface("rubber") = {1};
Physical Curve("hole") = {5, 6, 7, 8};
