// A quarter of a strip with a hole, by symmetry: half width 0.5 m, half length 1 m, radius 0.1 m. Lengths in m.
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 0.5};
Disk(2) = {0, 0, 0, 0.1};
BooleanDifference(3) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
Physical Surface("plate") = {3};
