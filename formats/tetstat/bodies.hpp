// bodies.hpp — the bodies, cavities and boundaries of a mesh as a list, for people and as JSON (TETSTATv1.md).
#pragma once
#include "formats/vtu/vtu.hpp"
#include "mesh/mesh_bodies.hpp"
#include <map>

namespace molmesh::formats {

/// Triangles of one label: `patch` where the mesh has a positive one, else `boundary`.
struct BoundarySummary {
  int32_t label = 0;
  std::string name;
  int64_t triangles = 0;
  double area = 0; ///< Å²
};

struct BodyList {
  std::string file;
  bool uncrossed = false;                     ///< triangles that cross were looked for, and there are none
  std::vector<MeshBody> body;                 ///< by region, then largest volume first
  std::vector<BoundarySummary> boundary;      ///< by label, ascending
  std::map<int32_t, std::string> region_name; ///< of the regions that the mesh itself names
  /// [body] the residues, or chains, of its triangles, most triangles first; empty: the mesh has no labels
  std::vector<std::vector<std::string>> residues;
  int64_t holes = 0; ///< of a mesh of the outside alone: connected parts of the molecule's surface
};

/// m is valid (validity.hpp). Same result at any number of threads.
BodyList list_bodies(const TetMesh& m, const std::string& file, int threads);

std::string bodies_text(const BodyList& list);
/// One JSON object and a line end.
std::string bodies_json(const BodyList& list);

} // namespace molmesh::formats
