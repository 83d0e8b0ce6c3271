// tetstat.hpp — what tetstat found, as text for people and as JSON (TETSTATv1.md).
#pragma once
#include "formats/vtu/vtu.hpp"
#include "mesh/quality.hpp"
#include "mesh/validity.hpp"
#include <map>
#include <optional>

namespace molmesh::formats {

struct MeshReport {
  std::string file, source, creator;
  double isovalue = 1;
  int64_t points = 0, tets = 0, triangles = 0;
  std::vector<std::array<int64_t, 2>> labels; ///< boundary label, its triangles; ascending
  int64_t parts = 0;                          ///< distinct METIS parts, 0: none
  MeshNotes notes;
  Validity validity;
  bool uncrossed = false;                     ///< triangles that cross were looked for, and there are none
  std::map<int32_t, std::string> region_name; ///< of domains
  std::map<int32_t, std::string> label_name;  ///< above 7, where there are domains
  std::optional<MeshQuality> quality;         ///< none where an index is out of range
  AngleLimits asked;
  std::optional<Sphere> sphere; ///< the outer boundary

  /// Angles within what was asked for.
  bool good() const { return quality && quality->all.outside == 0; }
};

MeshReport report_mesh(const TetMesh& m, const std::string& file, const MeshNotes& notes, Validity validity,
                       AngleLimits asked, int threads);

/// One JSON object and a line end.
std::string tetstat_json(const MeshReport& r);
std::string tetstat_text(const MeshReport& r);

/// Two meshes side by side, `a` before and `b` after.
std::string compare_json(const MeshReport& a, const MeshReport& b);
std::string compare_text(const MeshReport& a, const MeshReport& b);

} // namespace molmesh::formats
