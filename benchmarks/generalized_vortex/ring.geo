// A ring between the radii 0.75 and 1.25 m.
SetFactory("OpenCASCADE");
Disk(1) = {0, 0, 0, 1.25};
Disk(2) = {0, 0, 0, 0.75};
BooleanDifference{ Surface{1}; Delete; }{ Surface{2}; Delete; }
Physical Surface("ring") = Surface{:};
