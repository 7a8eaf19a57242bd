// Connecting rod with two eyes and fillets, meshed with tetrahedra of 10 nodes; sizes in metres.
//
//   gmsh -3 -setnumber fillet 0.004 rod.geo -o rod-mesh.inp
//
// The half above the plane of motion, z = 0. Sets of nodes: BIG_END, SMALL_END, SYMMETRY. Material and section are in
// a deck that includes the mesh; see "Modes from CalculiX" in fmu-harness/docs/guide.md.
SetFactory("OpenCASCADE");

DefineConstant[
  length = 0.12,
  big_bore = 0.016, big_radius = 0.023, big_thickness = 0.02,
  small_bore = 0.01, small_radius = 0.015, small_thickness = 0.02,
  shank_width_big = 0.02, shank_width_small = 0.014, shank_thickness = 0.008,
  fillet = 0.004,
  size = 0.004
];

Cylinder(1) = {0, 0, 0, 0, 0, big_thickness / 2, big_radius};
Cylinder(2) = {length, 0, 0, 0, 0, small_thickness / 2, small_radius};

// The shank from centre to centre: its widths are those at the eyes.
slope = (shank_width_small - shank_width_big) / (length - big_radius - small_radius) / 2;
wide = shank_width_big / 2 - slope * big_radius;
narrow = shank_width_small / 2 + slope * small_radius;
Point(101) = {0, -wide, 0};
Point(102) = {length, -narrow, 0};
Point(103) = {length, narrow, 0};
Point(104) = {0, wide, 0};
Line(101) = {101, 102};
Line(102) = {102, 103};
Line(103) = {103, 104};
Line(104) = {104, 101};
Curve Loop(101) = {101, 102, 103, 104};
Plane Surface(101) = {101};
shank[] = Extrude {0, 0, shank_thickness / 2} { Surface{101}; };
body() = BooleanUnion{ Volume{1}; Delete; }{ Volume{2, shank[1]}; Delete; };

Cylinder(11) = {0, 0, -1, 0, 0, 2, big_bore};
Cylinder(12) = {length, 0, -1, 0, 0, 2, small_bore};
rod() = BooleanDifference{ Volume{body()}; Delete; }{ Volume{11, 12}; Delete; };

// The upright edges where the shank's sides meet the eyes.
If(fillet > 0)
  near = 1e-3 * length;
  at_big = Sqrt(big_radius^2 - shank_width_big^2 / 4);
  at_small = length - Sqrt(small_radius^2 - shank_width_small^2 / 4);
  edges[] = {};
  For side In {-1:1:2}
    edges[] += Curve In BoundingBox{at_big - near, side * shank_width_big / 2 - near, -near,
      at_big + near, side * shank_width_big / 2 + near, shank_thickness / 2 + near};
    edges[] += Curve In BoundingBox{at_small - near, side * shank_width_small / 2 - near, -near,
      at_small + near, side * shank_width_small / 2 + near, shank_thickness / 2 + near};
  EndFor
  Fillet{rod()}{edges[]}{fillet}
EndIf

e = 1e-6;
Physical Volume("ROD") = Volume{:};
Physical Surface("BIG_END") = Surface In BoundingBox{-big_bore - e, -big_bore - e, -e,
  big_bore + e, big_bore + e, big_thickness / 2 + e};
Physical Surface("SMALL_END") = Surface In BoundingBox{length - small_bore - e, -small_bore - e, -e,
  length + small_bore + e, small_bore + e, small_thickness / 2 + e};
Physical Surface("SYMMETRY") = Surface In BoundingBox{-length, -length, -e, 2 * length, length, e};

Mesh.MeshSizeMax = size;
Mesh.MeshSizeFromCurvature = 24;
Mesh.ElementOrder = 2;
Mesh.SecondOrderLinear = 0;
Mesh.SaveGroupsOfNodes = 1;
