// mesh_code.cpp — grows each body from a tetrahedron across faces; what a new one adds is one corner.
#include "formats/html/mesh_code.hpp"
#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace molmesh::formats {
namespace {

void add_varint(std::string& s, uint64_t v) {
  for (; v >= 128; v >>= 7)
    s += static_cast<char>(v | 128);
  s += static_cast<char>(v);
}
uint64_t zigzag(int64_t v) {
  return static_cast<uint64_t>(v) << 1 ^ static_cast<uint64_t>(v >> 63);
}

/// The last points that a point was seen to share an edge with: a corner that is no new point is most often one of
/// those of the face's corners.
class Recent {
public:
  static constexpr int size = 16;
  explicit Recent(size_t points) : of_(points * size, -1), count_(points) {}
  /// Newest first; -1: none.
  int32_t get(int32_t point, int age) const {
    return of_[size_t(point) * size + ((count_[point] - 1 - age) & (size - 1))];
  }
  void add(int32_t a, int32_t b) {
    put(a, b);
    put(b, a);
  }

private:
  void put(int32_t point, int32_t other) {
    const int32_t* const row = &of_[size_t(point) * size];
    if (std::find(row, row + size, other) == row + size)
      of_[size_t(point) * size + (count_[point]++ & (size - 1))] = other;
  }
  std::vector<int32_t> of_;
  std::vector<uint8_t> count_; ///< modulo 256
};

class Encoder {
public:
  Encoder(const TetMesh& m, const TriangleSides& sides, const MeshBodies& bodies, const std::vector<uint8_t>& keep)
      : m_(m), sides_(sides), bodies_(bodies), keep_(keep), point_(m.point.size(), -1), recent_(m.point.size()) {
    code.place.assign(m.tet.size(), -1);
  }

  MeshCode code;

  void encode(const std::vector<CellLabel>& labels) {
    set_quantum();
    const size_t bodies = bodies_.body.size();
    // The tetrahedra of each body in turn.
    std::vector<int64_t> start(bodies + 1, 0);
    for (size_t t = 0; t < m_.tet.size(); ++t)
      start[size_t(bodies_.of[t])] += wanted(t);
    int64_t sum = 0;
    for (int64_t& s : start)
      sum += std::exchange(s, sum);
    LargeArray<int32_t> seeds(static_cast<size_t>(sum));
    std::vector<int64_t> to = start;
    for (size_t t = 0; t < m_.tet.size(); ++t)
      if (wanted(t))
        seeds[to[size_t(bodies_.of[t])]++] = static_cast<int32_t>(t);
    order_.reserve(static_cast<size_t>(sum));
    for (size_t b = 0; b < bodies; ++b) {
      for (int64_t i = start[b]; i < start[b + 1]; ++i)
        if (code.place[seeds[i]] < 0)
          grow(seeds[i]);
      code.body_tets.push_back(start[b + 1] - start[b]);
    }
    code.tets = static_cast<int64_t>(order_.size());
    code.points = static_cast<int64_t>(points_);
    code.stream = {{"faces", std::move(faces_)}, {"corners", std::move(corners_)}, {"far", std::move(far_)}};
    for (size_t axis = 0; axis < 3; ++axis) {
      code.stream.push_back({std::string("low_") + "xyz"[axis], std::move(low_[axis])});
      code.stream.push_back({std::string("high_") + "xyz"[axis], std::move(high_[axis])});
    }
    add_triangles();
    for (const CellLabel& l : labels)
      add_label(l);
  }

private:
  struct Coded {
    std::array<int32_t, 4> corner; ///< points of the mesh, in the order of the code
    int32_t tet, parent;           ///< parent: in the code, -1: a seed
  };

  bool wanted(size_t t) const { return keep_.empty() || keep_[t] != 0; }

  /// A 256th of the usual shortest edge: angles of elements are then off by a fifth of a degree at most or so.
  void set_quantum() {
    double sum = 0;
    Vec3d low = m_.point[0], high = low;
    for (const Vec3d& p : m_.point)
      for (int axis = 0; axis < 3; ++axis)
        low[axis] = std::min(low[axis], p[axis]), high[axis] = std::max(high[axis], p[axis]);
    for (const Tet& t : m_.tet) {
      double least = 1e300;
      for (int e = 0; e < 6; ++e)
        least = std::min(least, norm2(m_.point[t[size_t(tet_edge(e, 0))]] - m_.point[t[size_t(tet_edge(e, 1))]]));
      sum += std::sqrt(least);
    }
    const double size = std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-12}),
                 wish = std::max(sum / double(m_.tet.size()) / 256, size / (1 << 26));
    code.quantum = std::exp2(std::floor(std::log2(wish)));
    code.origin = low;
  }
  std::array<int64_t, 3> rounded(int32_t v) const {
    const Vec3d p = (m_.point[v] - code.origin) / code.quantum;
    return {std::llround(p.x), std::llround(p.y), std::llround(p.z)};
  }

  /// near: the points of the face, then the corner behind it; none for the first corners of a seed.
  void add_corner(int32_t v, const int32_t* near) {
    if (point_[v] < 0) {
      corners_ += '\0';
      point_[v] = points_++;
      std::array<int64_t, 3> predicted = last_;
      if (near) {
        const auto a = rounded(near[0]), b = rounded(near[1]), c = rounded(near[2]), d = rounded(near[3]);
        for (size_t k = 0; k < 3; ++k) // the mirror image of the corner behind
          predicted[k] = static_cast<int64_t>(std::floor(double(2 * (a[k] + b[k] + c[k])) / 3)) - d[k];
      }
      const auto at = rounded(v);
      for (size_t k = 0; k < 3; ++k) {
        const uint64_t z = zigzag(at[k] - predicted[k]);
        low_[k] += static_cast<char>(z);
        add_varint(high_[k], z >> 8);
      }
      last_ = at;
      return;
    }
    for (int age = 0; near && age < Recent::size; ++age)
      for (int k = 0; k < 3; ++k)
        if (recent_.get(near[k], age) == v) {
          corners_ += static_cast<char>(1 + 3 * age + k);
          return;
        }
    corners_ += static_cast<char>(1 + 3 * Recent::size);
    add_varint(far_, static_cast<uint64_t>(points_ - point_[v]));
  }

  void grow(int32_t seed) {
    size_t next = order_.size();
    Coded first{m_.tet[seed], seed, -1};
    for (const int32_t v : first.corner)
      add_corner(v, nullptr);
    for (size_t e = 0; e < 6; ++e)
      recent_.add(first.corner[size_t(tet_edge(int(e), 0))], first.corner[size_t(tet_edge(int(e), 1))]);
    add(first);
    for (; next < order_.size(); ++next) {
      const Coded c = order_[next];
      const int faces = c.parent < 0 ? 4 : 3; // the last is the one that it was reached across
      int mask = 0;
      for (int f = 0; f < faces; ++f) {
        const auto& own = m_.tet[c.tet];
        const auto at = std::find(own.begin(), own.end(), c.corner[size_t(f)]) - own.begin();
        const int32_t other = sides_.across[4 * int64_t{c.tet} + at];
        if (other < 0)
          continue;
        const int32_t t = other / 4;
        if (code.place[t] >= 0 || !wanted(size_t(t)) || bodies_.of[t] != bodies_.of[c.tet])
          continue;
        mask |= 1 << f;
        Coded reached{{c.corner[size_t(tet_face(f, 0))], c.corner[size_t(tet_face(f, 1))],
                       c.corner[size_t(tet_face(f, 2))], m_.tet[t][size_t(other % 4)]},
                      t,
                      static_cast<int32_t>(next)};
        const int32_t near[4] = {reached.corner[0], reached.corner[1], reached.corner[2], c.corner[size_t(f)]};
        add_corner(reached.corner[3], near);
        for (size_t k = 0; k < 3; ++k)
          recent_.add(reached.corner[3], reached.corner[k]);
        add(reached);
      }
      faces_ += static_cast<char>(mask);
    }
  }
  void add(const Coded& c) {
    code.place[c.tet] = static_cast<int32_t>(order_.size());
    order_.push_back(c);
  }

  /// Number of a face in the code: of which corner it is opposite.
  int64_t coded(int32_t face) const {
    const Coded& c = order_[size_t(code.place[face / 4])];
    const int32_t corner = m_.tet[face / 4][size_t(face % 4)];
    return 4 * int64_t{code.place[face / 4]} +
           (std::find(c.corner.begin(), c.corner.end(), corner) - c.corner.begin());
  }

  void add_triangles() {
    for (size_t i = 0; i < m_.tri.size(); ++i) {
      const auto& side = sides_.face[i];
      if (side[0] < 0)
        continue; // of an invalid mesh
      int64_t own = coded(side[0]), other = 0;
      if (side[1] >= 0) {
        const int64_t far = coded(side[1]);
        const bool swapped = far < own;
        own = std::min(own, far);
        other = 1 + bodies_.of[side[swapped ? 0 : 1] / 4];
      }
      triangles_.push_back({own, other, static_cast<int32_t>(i)});
    }
    std::sort(triangles_.begin(), triangles_.end(), [](const Triangle& a, const Triangle& b) {
      return a.face != b.face ? a.face < b.face : a.index < b.index;
    });
    std::string faces, others;
    int64_t last = 0;
    for (const Triangle& t : triangles_) {
      add_varint(faces, static_cast<uint64_t>(t.face - last));
      add_varint(others, static_cast<uint64_t>(t.other));
      last = t.face;
    }
    code.stream.push_back({"triangles", std::move(faces)});
    code.stream.push_back({"others", std::move(others)});
  }

  void add_label(const CellLabel& l) {
    std::string names;
    for (const std::string& n : l.names)
      names += n + '\n';
    code.stream.push_back({"names " + l.name, std::move(names)});
    const auto value = [&](size_t k) { return l.tet.empty() ? 0 : l.tet[size_t(order_[k].tet)]; };
    if (!l.tet.empty()) {
      std::string tets;
      for (size_t k = 0; k < order_.size(); ++k)
        add_varint(tets, zigzag(int64_t{value(k)} - (order_[k].parent >= 0 ? value(size_t(order_[k].parent)) : 0)));
      code.stream.push_back({"tets " + l.name, std::move(tets)});
    }
    if (!l.tri.empty()) {
      std::string tris;
      for (const Triangle& t : triangles_)
        add_varint(tris, zigzag(int64_t{l.tri[size_t(t.index)]} - value(size_t(t.face / 4))));
      code.stream.push_back({"triangles " + l.name, std::move(tris)});
    }
  }

  struct Triangle {
    int64_t face, other;
    int32_t index;
  };
  const TetMesh& m_;
  const TriangleSides& sides_;
  const MeshBodies& bodies_;
  const std::vector<uint8_t>& keep_;
  std::vector<int32_t> point_; ///< [points of the mesh] number in the code
  int32_t points_ = 0;
  Recent recent_; ///< by points of the mesh
  std::vector<Coded> order_;
  std::vector<Triangle> triangles_;
  std::string faces_, corners_, far_, low_[3], high_[3];
  std::array<int64_t, 3> last_{};
};

} // namespace

MeshCode encode_mesh(const TetMesh& m, const TriangleSides& sides, const MeshBodies& bodies,
                     const std::vector<uint8_t>& keep, const std::vector<CellLabel>& labels) {
  Encoder e(m, sides, bodies, keep);
  e.encode(labels);
  return std::move(e.code);
}

} // namespace molmesh::formats
