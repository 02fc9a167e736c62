// A layer 1 m thick on the outside of a circle of 4 m, and room above it.
SetFactory("OpenCASCADE");
Circle(1) = {0, 0, 0, 4};
Circle(2) = {0, 0, 0, 5};
Circle(3) = {0, 0, 0, 5.25};
Curve Loop(1) = {1};
Curve Loop(2) = {2};
Curve Loop(3) = {3};
Plane Surface(1) = {2, 1};
Plane Surface(2) = {3, 2};
Physical Surface("layer") = {1};
Physical Surface("air") = {2};
Physical Curve("base") = {1};
