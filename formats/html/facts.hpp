// facts.hpp — what a report says of a mesh in numbers, as JSON for its page.
#pragma once
#include "formats/html/html.hpp"

namespace molmesh::formats {

/// The worst tetrahedra by the optimizer's quality (conventions.md), the first of equals first; at most `most`.
std::vector<int64_t> worst_by_quality(const TetMesh& m, size_t most, int threads);

/// A JSON object without its last brace, so that more keys can follow. place: MeshCode::place, or empty.
std::string facts_json(const TetMesh& m, const TriangleSides& sides, const MeshBodies& bodies,
                       const std::vector<CellLabel>& labels, const ReportedMesh& more,
                       const std::vector<int64_t>& worst, const LargeArray<int32_t>& place, int threads);

} // namespace molmesh::formats
