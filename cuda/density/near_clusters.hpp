// near_clusters.hpp — finds the clusters near cubes of a few blocks once, through the molecule's boxes; a block's
// own are among its cube's, which a team of threads looks through side by side.
#pragma once
#include "cuda/density/block_key.hpp"
#include "cuda/density/bvh.hpp"

namespace molmesh::cuda {

/// Clusters nearer to a box than their cutoff, as plain views.
struct NearClusters {
  FieldView f;
  BlockFrame frame;
  int32_t edge;         ///< of a cube, in blocks: a power of two
  const Key* cube;      ///< [cubes] ascending
  const int64_t* begin; ///< [cubes + 1]
  const int32_t* list;  ///< ascending in each cube
  int64_t cubes;

  /// see(c, whether c is near) for the clusters of the block's cube, of which no other is near the block: a cluster
  /// for each thread of the team, all of them as often; a thread without one gets -1, which is not near.
  template <class Team, class See>
  MOLMESH_HD void for_each(Vec3i block, const Box& box, Team team, See&& see) const {
    const int32_t below = edge - 1;
    const int64_t i =
        find_key(cube, cubes, BlockFrame::key({block.x & ~below, block.y & ~below, block.z & ~below}));
    if (i < 0)
      return;
    for (int64_t first = begin[i]; first < begin[i + 1]; first += Team::size) {
      const int64_t k = first + team.rank();
      const int32_t c = k < begin[i + 1] ? list[k] : -1;
      see(c, c >= 0 && density::distance2(box, f.box[c]) < f.cutoff2[c]);
    }
  }
};

/// Without a list: begin[i], how many clusters are near cube i; with one: which, from list[begin[i]] on.
struct ListNearCubes {
  FieldView f;
  BlockFrame frame;
  int32_t edge;
  const Key* cube;
  int64_t* begin;
  int32_t* list;

  MOLMESH_HD void operator()(int64_t i) const {
    int32_t* const to = list ? list + begin[i] : nullptr;
    int64_t n = 0;
    for_near_clusters(f, frame.box(BlockFrame::block(cube[i]), edge), [&](int32_t c) {
      if (to)
        to[n] = c;
      ++n;
      return true;
    });
    if (!to)
      begin[i] = n;
  }
};

} // namespace molmesh::cuda
