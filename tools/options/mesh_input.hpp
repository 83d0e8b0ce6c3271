// mesh_input.hpp — options of every program that reads a mesh, and the reading.
#pragma once
#include "base/give_back_memory.hpp"
#include "cli/run.hpp"
#include "formats/mesh/read_mesh.hpp"

namespace molmesh {

struct MeshInput {
  std::string region_array;
  bool merge_points = false;
  double scale = 1;
};

inline void describe_mesh_input(cli::Table& t, MeshInput& o) {
  t.group("mesh that is read");
  t.add("--region-array", o.region_array,
        "cell array that holds the regions; without it region, gmsh:physical, medit:ref, MaterialIds and other "
        "usual names are looked for")
      .unit("NAME");
  t.add("--merge-points", o.merge_points, "points with the same coordinates become one, pieces are joined");
  t.add("--scale", o.scale, "factor of all coordinates: 10 makes Å of nanometres").positive();
}

/// The mesh in an open file, .vtu, .msh, .mesh or .vtk; what a user should know is noted.
inline TetMesh read_mesh(cli::Run& run, cli::InputFile& input, const MeshInput& o, formats::CellArrays arrays,
                         formats::MeshNotes& notes) {
  formats::MeshReading as;
  as.arrays = arrays;
  as.region_array = o.region_array;
  as.merge_points = o.merge_points;
  as.scale = o.scale;
  TetMesh mesh = formats::read_mesh(input.stream(), input.name(), as, notes);
  give_back_memory(); // of the file's bytes, which are more than the mesh
  run.notes(described(notes));
  return mesh;
}

} // namespace molmesh
