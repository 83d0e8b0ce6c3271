// validity_duplicates.cpp — hashes points; compares tetrahedra that share faces.
#include "mesh/validity_duplicates.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/group_by_key.hpp"
#include <bit>

namespace molmesh {

std::vector<int32_t> point_twins(const std::vector<Vec3d>& point, int threads) {
  const auto n_points = static_cast<int64_t>(point.size());
  const auto bits = [](double x) { return std::bit_cast<uint64_t>(x + 0.0); };
  const auto mix = [](uint64_t h) {
    h ^= h >> 32;
    h *= 0x9e3779b97f4a7c15;
    return h ^ h >> 29;
  };
  std::vector<int32_t> twin(point.size(), -1);
  for_each_group(
      n_points, n_points, threads,
      [&](int64_t i) {
        const Vec3d p = point[i];
        const uint64_t h = mix(mix(mix(bits(p.x)) + bits(p.y)) + bits(p.z));
        return GroupKey{static_cast<int32_t>((h >> 32) * static_cast<uint64_t>(n_points) >> 32), h};
      },
      [&](const uint32_t* p, int n) {
        for (int i = 1; i < n; ++i)
          for (int k = 0; k < i && twin[p[i]] < 0; ++k)
            if (point[p[i]] == point[p[k]])
              twin[p[i]] = static_cast<int32_t>(p[k]);
      });
  return twin;
}

std::vector<int64_t> tet_copies(const TetMesh& m, const LargeArray<int32_t>& across) {
  // Two faces cover all four points: tetrahedra that share two are the same. Those with a face in more than two are
  // few.
  std::vector<int64_t> copies;
  std::vector<std::pair<Tet, int64_t>> suspect;
  for (size_t i = 0; i < m.tet.size(); ++i) {
    int faces = 0;
    bool copy = false;
    for (size_t f = 0; f < 4; ++f) {
      const int32_t a = across[4 * i + f];
      faces += a == crowded_face;
      for (size_t g = 0; g < f && a >= 0; ++g) {
        const int32_t b = across[4 * i + g];
        copy |= b >= 0 && a / 4 == b / 4 && static_cast<size_t>(a / 4) < i;
      }
    }
    if (copy) {
      copies.push_back(static_cast<int64_t>(i));
    } else if (faces >= 2) {
      suspect.emplace_back(m.tet[i], static_cast<int64_t>(i));
      std::sort(suspect.back().first.begin(), suspect.back().first.end());
    }
  }
  std::sort(suspect.begin(), suspect.end());
  for (size_t i = 1; i < suspect.size(); ++i)
    if (suspect[i].first == suspect[i - 1].first)
      copies.push_back(suspect[i].second);
  std::sort(copies.begin(), copies.end());
  return copies;
}

} // namespace molmesh
