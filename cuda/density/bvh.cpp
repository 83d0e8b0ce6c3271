// bvh.cpp — builds nodes from the outermost groups down, at most eight children each.
#include "cuda/density/bvh.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace molmesh::cuda {
namespace {

constexpr size_t most_children = 8;

float down(double v) {
  const auto f = static_cast<float>(v);
  return f <= v ? f : std::nextafter(f, -std::numeric_limits<float>::infinity());
}
float up(double v) {
  return -down(-v);
}

class Builder {
public:
  explicit Builder(const density::Field& f) : f_(f) {
    group_.resize(f.level.size());
    group_[0] = f.group;
    for (size_t l = 1; l < f.level.size(); ++l)
      for (const int64_t g : group_[l - 1])
        group_[l].push_back(f.level[l - 1].parent[g]);
  }
  std::vector<BvhNode> run() {
    divide(0, f_.group.size(), f_.level.size());
    return std::move(node_);
  }

private:
  /// Clusters [begin, end): groups of level - 1, or single clusters below the innermost.
  void divide(size_t begin, size_t end, size_t level) {
    std::vector<size_t> cut;
    for (size_t c = begin; c < end; ++c)
      if (c == begin || level == 0 || group_[level - 1][c] != group_[level - 1][c - 1])
        cut.push_back(c);
    cut.push_back(end);
    gather(cut.data(), cut.size() - 1, level);
  }
  /// Pieces [cut[i], cut[i + 1]) in runs, so that no node has many children.
  void gather(const size_t* cut, size_t pieces, size_t level) {
    size_t run = 1;
    while (run * most_children < pieces)
      run *= most_children;
    for (size_t i = 0; i < pieces; i += run)
      add(cut + i, std::min(run, pieces - i), level);
  }
  void add(const size_t* cut, size_t pieces, size_t level) {
    const size_t begin = cut[0], end = cut[pieces], at = node_.size();
    const bool leaf = end - begin == 1;
    const auto c = static_cast<int32_t>(begin);
    node_.push_back({{}, {}, 0, 0, leaf ? c : -1});
    if (!leaf && pieces > 1)
      gather(cut, pieces, level);
    else if (!leaf)
      divide(begin, end, level - 1);
    constexpr float infinity = std::numeric_limits<float>::infinity();
    BvhNode n{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}, 0, 0, leaf ? c : -1};
    for (size_t k = begin; k < end; ++k) {
      for (int a = 0; a < 3; ++a) {
        n.lo[a] = std::min(n.lo[a], down(f_.box[k].lo[a]));
        n.hi[a] = std::max(n.hi[a], up(f_.box[k].hi[a]));
      }
      n.cutoff2 = std::max(n.cutoff2, up(f_.cutoff2[k]));
    }
    n.skip = static_cast<int32_t>(node_.size());
    node_[at] = n;
  }

  const density::Field& f_;
  std::vector<std::vector<int64_t>> group_; ///< per level, of each cluster
  std::vector<BvhNode> node_;
};

} // namespace

std::vector<BvhNode> bvh(const density::Field& f) {
  return Builder(f).run();
}

} // namespace molmesh::cuda
