// html.hpp — a report about meshes as one page that any browser opens without a network (HTML.md).
#pragma once
#include "formats/html/colouring.hpp"
#include "mesh/quality.hpp"
#include "mesh/validity.hpp"
#include <iosfwd>
#include <memory>
#include <optional>

namespace molmesh::formats {

/// What is known of a mesh besides itself.
struct ReportedMesh {
  std::string name, file;              ///< as shown; as given
  std::vector<std::string> notes;      ///< what its reader had to decide
  std::optional<Validity> validity;    ///< none: not asked for
  std::vector<std::string> run_report; ///< JSON objects (REPORTv1.md), the first program of the chain first
  std::string picture;                 ///< PNG, for the gallery and where there is no WebGL
  std::string colour;                  ///< of the surface at first; as colouring_by
};

/// Adds meshes one by one, so that one at a time is in memory.
class HtmlReport {
public:
  /// most_bytes: about what the page may have. meshes: how many will come; each gets its share of what is left.
  HtmlReport(int64_t most_bytes, int64_t meshes);
  ~HtmlReport();
  HtmlReport(HtmlReport&&) noexcept;

  /// Same mesh, same bytes at any number of threads.
  void add(const TetMesh& m, const TriangleSides& sides, const MeshBodies& bodies,
           const std::vector<CellLabel>& labels, const ReportedMesh& more, int threads);
  /// What was left out of the page, a line a mesh.
  std::vector<std::string> left_out() const;
  /// Is three.js part of this program? Without it the page has stills.
  static bool has_3d();
  void write(std::ostream& out, const std::string& title, const std::string& creator) const;

private:
  struct Pages;
  std::unique_ptr<Pages> pages_;
};

} // namespace molmesh::formats
