// A quarter of a rod that stands on the plane z = 0, and the room it may spread into: ETP copper, 30 x 6 mm. Lengths in m.
length = 30.0e-3; radius = 3.0e-3;
Include "rod.geo";
