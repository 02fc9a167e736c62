// A quarter of a rod that stands on the plane z = 0, and the room it may spread into: OFHC copper, 23.47 x 7.62 mm. Lengths in m.
length = 23.47e-3; radius = 3.81e-3;
Include "rod.geo";
