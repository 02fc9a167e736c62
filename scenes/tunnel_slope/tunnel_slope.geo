// A slope with a curved face above a lined circular tunnel, 60 m x 30 m.  No structured grid fits its boundary.
// Made into tunnel_slope.msh with:  gmsh -2 -format msh41 tunnel_slope.geo
// (format 2.2, ascii or binary, would do as well).

fine = 0.6;    // edge length at the tunnel [m]
medium = 1.0;  // at the slope
coarse = 1.6;  // at the outer boundary

// Outer corners.
Point(1) = {0, 0, 0, coarse};
Point(2) = {60, 0, 0, coarse};
Point(3) = {60, 24, 0, coarse};
Point(4) = {60, 30, 0, coarse};
Point(5) = {0, 30, 0, coarse};
Point(6) = {0, 12, 0, coarse};

// Ground: bench, concave toe, face, convex crest.
Point(7) = {16, 12, 0, medium};
Point(8) = {20, 13.2, 0, medium};
Point(9) = {24, 16.5, 0, medium};
Point(10) = {28, 20.6, 0, medium};
Point(11) = {32, 23.2, 0, medium};
Point(12) = {36, 24, 0, medium};

Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Line(7) = {6, 7};
Spline(8) = {7, 8, 9, 10, 11, 12};
Line(9) = {12, 3};

// Tunnel: centre (38, 9) m, radius 4 m.
Point(20) = {38, 9, 0, fine};
Point(21) = {42, 9, 0, fine};
Point(22) = {38, 13, 0, fine};
Point(23) = {34, 9, 0, fine};
Point(24) = {38, 5, 0, fine};
Circle(20) = {21, 20, 22};
Circle(21) = {22, 20, 23};
Circle(22) = {23, 20, 24};
Circle(23) = {24, 20, 21};

Curve Loop(1) = {1, 2, -9, -8, -7, 6};
Curve Loop(2) = {20, 21, 22, 23};
Plane Surface(1) = {1, 2};
Curve Loop(3) = {3, 4, 5, 7, 8, 9};
Plane Surface(2) = {3};

Physical Surface("soil") = {1};
Physical Surface("air") = {2};
Physical Curve("base") = {1};
Physical Curve("right") = {2, 3};
Physical Curve("left") = {5, 6};
Physical Curve("top") = {4};
Physical Curve("ground") = {7, 8, 9};
Physical Curve("tunnel") = {20, 21, 22, 23};
