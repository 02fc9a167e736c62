// A quarter of a rod that stands on the plane z = 0, and the room it may spread into: OFHC M1 copper, 34.5 x 7.8 mm. Lengths in m.
length = 34.5e-3; radius = 3.9e-3;
Include "rod.geo";
