// An L of 20 mm x 20 mm without its upper right quarter, area 300 mm^2: quadrangles below, triangles in the arm, of second
// order, with the nodes' parameters.
Point(1) = {0, 0, 3, 5};
Point(2) = {20, 0, 3, 5};
Point(3) = {20, 10, 3, 5};
Point(4) = {10, 10, 3, 5};
Point(5) = {10, 20, 3, 5};
Point(6) = {0, 20, 3, 5};
Point(7) = {0, 10, 3, 5};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 1};
Line(8) = {7, 4};
Curve Loop(1) = {1, 2, 3, -8, 7};
Curve Loop(2) = {8, 4, 5, 6};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Recombine Surface {1};
Physical Surface("foot") = {1};
Physical Surface("arm") = {2};
Physical Curve("top edge", 12) = {5};
Physical Curve(13) = {1};
Mesh.ElementOrder = 2;
Mesh.SaveParametric = 1;
