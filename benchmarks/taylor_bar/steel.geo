// A quarter of a rod that stands on the plane z = 0, and the room it may spread into: 4340 steel, 37.97 x 7.595 mm. Lengths in m.
length = 37.97e-3; radius = 3.7975e-3;
Include "rod.geo";
