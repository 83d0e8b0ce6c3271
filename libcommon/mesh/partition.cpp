// partition.cpp — the dual graph for METIS.
#include "mesh/partition.hpp"
#include "error.hpp"
#include "mesh/adjacency.hpp"
#include "par/par.hpp"
#include <metis.h>

namespace molmesh {

static_assert(sizeof(idx_t) == sizeof(int32_t), "METIS with 32-bit indices");

std::vector<int32_t> partition(const TetMesh& m, int parts, int threads) {
  auto n = static_cast<idx_t>(m.tet.size());
  std::vector<idx_t> part(m.tet.size(), 0);
  idx_t k = std::min<idx_t>(parts, n);
  if (k <= 1)
    return part;

  const std::vector<int32_t> across = face_neighbors(m, threads);
  std::vector<idx_t> begin(m.tet.size() + 1, 0);
  const auto neighbors = [&](int64_t tet, auto&& visit) {
    for (int64_t f = 4 * tet; f < 4 * tet + 4; ++f)
      if (const int32_t other = across[static_cast<size_t>(f)]; other >= 0)
        visit(other / 4);
  };
  par::for_n(n, threads, [&](int64_t t) { neighbors(t, [&](idx_t) { ++begin[static_cast<size_t>(t)]; }); });
  std::vector<idx_t> neighbor(static_cast<size_t>(par::exclusive_scan(begin)));
  par::for_n(n, threads, [&](int64_t t) {
    auto at = static_cast<size_t>(begin[static_cast<size_t>(t)]);
    neighbors(t, [&](idx_t other) { neighbor[at++] = other; });
  });

  idx_t options[METIS_NOPTIONS], constraints = 1, cut = 0;
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NUMBERING] = 0;
  const int status = METIS_PartGraphKway(&n, &constraints, begin.data(), neighbor.data(), nullptr, nullptr, nullptr,
                                         &k, nullptr, nullptr, options, &cut, part.data());
  if (status != METIS_OK)
    fail(Status::failed, "METIS cannot partition this mesh (status " + std::to_string(status) + ")");
  return part;
}

} // namespace molmesh
