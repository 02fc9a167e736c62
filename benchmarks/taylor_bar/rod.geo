// Included by the geometries of the rods, which set length and radius.
SetFactory("OpenCASCADE");
slack = 1e-3 * radius;
Cylinder(1) = {0, 0, 0, 0, 0, length, radius, Pi / 2};
Cylinder(2) = {0, 0, 0, 0, 0, length + radius, 1.6 * radius, Pi / 2};
Cylinder(3) = {0, 0, 0, 0, 0, 0.35 * length, 3.3 * radius, Pi / 2};
BooleanFragments{ Volume{1, 2, 3}; Delete; }{}
rod() = Volume In BoundingBox{-slack, -slack, -slack, radius + slack, radius + slack, length + slack};
room() = Volume{:};
room() -= rod();
Physical Volume("rod") = rod();
Physical Volume("room") = room();
