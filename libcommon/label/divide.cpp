// divide.cpp — points of equal shares on edges, faces and in tetrahedra; the pieces between them.
#include "label/divide.hpp"
#include "base/error.hpp"
#include "geom/tet_measures.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <set>

namespace molmesh::label {
namespace {

/// No point is nearer than this to the ends of its edge, as a share of it, and none has a smaller barycentric
/// coordinate in its face or tetrahedron.
constexpr double least_share = 0.1;

/// Between corners of as many groups: where all shares are equal if their logarithms are linear in between.
template <size_t N>
Vec3d equal_place(const std::array<Vec3d, N>& p, const std::array<const Shares*, N>& s) {
  // Rows k = 1 … N - 1: Σ_j w_j (ln share_k - ln share_0)(j) = 0, and Σ_j w_j = 1.
  std::array<std::array<double, N + 1>, N> row{};
  for (size_t k = 0; k < N; ++k) {
    for (size_t j = 0; j < N; ++j)
      row[k][j] = k == 0 ? 1 : s[j]->ln_of(s[k]->owner()) - s[j]->ln_of(s[0]->owner());
    row[k][N] = k == 0;
  }
  std::array<double, N> w;
  w.fill(1. / N);
  bool regular = true;
  for (size_t c = 0; c < N && regular; ++c) {
    size_t pivot = c;
    for (size_t k = c + 1; k < N; ++k)
      if (std::abs(row[k][c]) > std::abs(row[pivot][c]))
        pivot = k;
    std::swap(row[c], row[pivot]);
    regular = std::abs(row[c][c]) > 1e-12;
    for (size_t k = 0; regular && k < N; ++k)
      if (k != c) {
        const double f = row[k][c] / row[c][c];
        for (size_t j = c; j <= N; ++j)
          row[k][j] -= f * row[c][j];
      }
  }
  double sum = 0;
  for (size_t k = 0; k < N; ++k) {
    if (regular)
      w[k] = std::clamp(row[k][N] / row[k][k], least_share, 1.);
    sum += w[k];
  }
  Vec3d x;
  for (size_t k = 0; k < N; ++k)
    x += w[k] / sum * p[k];
  for (int a = 0; a < 3; ++a) // walls stay planes to the last bit
    if (std::all_of(p.begin(), p.end(), [&](const Vec3d& q) { return q[a] == p[0][a]; }))
      x[a] = p[0][a];
  return x;
}

template <size_t N>
using Key = std::array<int32_t, N>; ///< ascending vertices

/// The simplices of N corners that get a point, in order, and the first of these points.
template <size_t N>
struct Starred {
  std::vector<Key<N>> key;
  int32_t first = 0;
  int32_t find(const Key<N>& k) const {
    const auto at = std::lower_bound(key.begin(), key.end(), k);
    return at != key.end() && *at == k ? first + static_cast<int32_t>(at - key.begin()) : -1;
  }
};

class Divider {
public:
  Divider(TetMesh& m, const ShareFinder& shares, int threads)
      : m_(m), threads_(threads), owner_(m.point.size(), -1) {
    find_owners(shares);
    find_starred();
    add_points();
  }

  Division run() {
    divide_tets();
    divide_triangles();
    Division d;
    std::vector<int32_t> groups;
    for (const int32_t g : owner_)
      if (g >= 0)
        groups.push_back(g);
    par::sort_unique(groups, threads_);
    d.group = std::move(groups);
    add_interfaces(d);
    return d;
  }

private:
  void find_owners(const ShareFinder& shares) {
    for (size_t t = 0; t < m_.tet.size(); ++t)
      if (m_.region[t] == Region::molecule)
        for (const int32_t v : m_.tet[t])
          owner_[v] = 0;
    std::vector<Vec3d> place;
    std::vector<int32_t> vertex;
    for (size_t v = 0; v < owner_.size(); ++v)
      if (owner_[v] == 0) {
        vertex.push_back(static_cast<int32_t>(v));
        place.push_back(m_.point[v]);
      }
    if (vertex.empty())
      fail_input("no tetrahedron of region 1, expected a molecule");
    share_ = shares.at(place);
    share_of_.assign(owner_.size(), -1);
    for (size_t i = 0; i < vertex.size(); ++i) {
      owner_[vertex[i]] = share_[i].owner();
      share_of_[vertex[i]] = static_cast<int32_t>(i);
    }
  }

  template <size_t N>
  bool all_differ(const Key<N>& k) const {
    for (size_t i = 0; i < N; ++i)
      for (size_t j = 0; j < i; ++j)
        if (owner_[k[i]] == owner_[k[j]])
          return false;
    return true;
  }

  void find_starred() {
    for (size_t t = 0; t < m_.tet.size(); ++t) {
      if (m_.region[t] != Region::molecule)
        continue;
      Tet v = m_.tet[t];
      if (owner_[v[0]] == owner_[v[1]] && owner_[v[0]] == owner_[v[2]] && owner_[v[0]] == owner_[v[3]])
        continue;
      std::sort(v.begin(), v.end());
      for (size_t i = 0; i < 4; ++i)
        for (size_t j = i + 1; j < 4; ++j) {
          if (const Key<2> e{v[i], v[j]}; all_differ(e))
            edge_.key.push_back(e);
          for (size_t k = j + 1; k < 4; ++k)
            if (const Key<3> f{v[i], v[j], v[k]}; all_differ(f))
              face_.key.push_back(f);
        }
      if (all_differ(v))
        tet_.key.push_back(v);
    }
    par::sort_unique(edge_.key, threads_);
    par::sort_unique(face_.key, threads_);
    par::sort_unique(tet_.key, threads_);
    old_points_ = static_cast<int32_t>(m_.point.size());
    const size_t all = m_.point.size() + edge_.key.size() + face_.key.size() + tet_.key.size();
    if (all > static_cast<size_t>(INT32_MAX))
      fail(Status::failed, "the divided mesh has over 2^31 - 1 points, expected fewer");
    edge_.first = old_points_;
    face_.first = edge_.first + static_cast<int32_t>(edge_.key.size());
    tet_.first = face_.first + static_cast<int32_t>(face_.key.size());
    m_.point.resize(all);
  }

  template <size_t N>
  void place(const Starred<N>& starred) {
    par::for_n(static_cast<int64_t>(starred.key.size()), threads_, [&](int64_t i) {
      std::array<Vec3d, N> p;
      std::array<const Shares*, N> s;
      for (size_t k = 0; k < N; ++k) {
        p[k] = m_.point[starred.key[i][k]];
        s[k] = &share_[share_of_[starred.key[i][k]]];
      }
      m_.point[starred.first + i] = equal_place(p, s);
    });
  }
  void add_points() {
    place(edge_);
    place(face_);
    place(tet_);
  }

  /// Pieces of a cell of N corners: the simplex `key` in them is starred with v.
  template <size_t N, size_t K>
  static void star(std::vector<std::array<int32_t, N>>& piece, const Key<K>& key, int32_t v) {
    const size_t before = piece.size();
    for (size_t i = 0; i < before; ++i) {
      const auto has = [&](int32_t w) { return std::find(piece[i].begin(), piece[i].end(), w) - piece[i].begin(); };
      std::array<std::ptrdiff_t, K> at;
      bool all = true;
      for (size_t k = 0; k < K; ++k) {
        at[k] = has(key[k]);
        all = all && at[k] < static_cast<std::ptrdiff_t>(N);
      }
      if (!all)
        continue;
      const std::array<int32_t, N> whole = piece[i];
      for (size_t k = 0; k < K; ++k) {
        auto& p = k == 0 ? piece[i] : piece.emplace_back(whole);
        p[static_cast<size_t>(at[k])] = v;
      }
    }
  }

  /// In the order of the dimension, then of the vertices: cells on both sides of a face divide it alike.
  template <size_t N>
  void divide_cell(const std::array<int32_t, N>& cell, std::vector<std::array<int32_t, N>>& piece) const {
    piece.assign(1, cell);
    std::array<int32_t, N> v = cell;
    std::sort(v.begin(), v.end());
    if (std::all_of(v.begin(), v.end(), [&](int32_t w) { return owner_[w] == owner_[v[0]]; }))
      return;
    if constexpr (N == 4)
      if (const int32_t x = tet_.find(v); x >= 0)
        star(piece, v, x);
    for (size_t i = 0; i < N; ++i)
      for (size_t j = i + 1; j < N; ++j)
        for (size_t k = j + 1; k < N; ++k)
          if (const Key<3> f{v[i], v[j], v[k]}; all_differ(f))
            if (const int32_t x = face_.find(f); x >= 0)
              star(piece, f, x);
    for (size_t i = 0; i < N; ++i)
      for (size_t j = i + 1; j < N; ++j)
        if (const Key<2> e{v[i], v[j]}; all_differ(e))
          if (const int32_t x = edge_.find(e); x >= 0)
            star(piece, e, x);
  }

  int32_t region_of(const Tet& piece) const {
    for (const int32_t v : piece)
      if (v < old_points_)
        return first_domain + owner_[v];
    return 0; // there is none
  }

  void divide_tets() {
    const LargeArray<Tet> tet = std::move(m_.tet);
    const std::vector<int32_t> region = std::move(m_.region);
    m_.tet = {};
    m_.region = {};
    m_.tet.reserve(tet.size() + 4 * edge_.key.size());
    m_.region.reserve(tet.size() + 4 * edge_.key.size());
    std::vector<Tet> piece;
    for (size_t t = 0; t < tet.size(); ++t) {
      divide_cell(tet[t], piece);
      for (const Tet& p : piece) {
        m_.tet.push_back(p);
        m_.region.push_back(region[t] == Region::molecule ? region_of(p) : region[t]);
      }
    }
  }

  void divide_triangles() {
    const std::vector<Tri> tri = std::move(m_.tri);
    const std::vector<int32_t> boundary = std::move(m_.boundary);
    m_.tri.clear();
    m_.boundary.clear();
    std::vector<Tri> piece;
    for (size_t t = 0; t < tri.size(); ++t) {
      divide_cell(tri[t], piece);
      for (const Tri& p : piece) {
        m_.tri.push_back(p);
        m_.boundary.push_back(boundary[t]);
      }
    }
  }

  /// Their corners are all new: an old one belongs to one group alone.
  void add_interfaces(Division& d) {
    struct Face {
      Key<3> key;
      size_t tet;
      int corner;
    };
    std::vector<Face> face;
    for (size_t t = 0; t < m_.tet.size(); ++t)
      for (int f = 0; f < 4 && m_.region[t] >= first_domain; ++f) {
        const Tet& v = m_.tet[t];
        Key<3> k{v[tet_face(f, 0)], v[tet_face(f, 1)], v[tet_face(f, 2)]};
        if (*std::min_element(k.begin(), k.end()) < old_points_)
          continue;
        std::sort(k.begin(), k.end());
        face.push_back({k, t, f});
      }
    par::sort(face, threads_,
              [](const Face& a, const Face& b) { return a.key != b.key ? a.key < b.key : a.tet < b.tet; });
    std::map<std::array<int32_t, 2>, std::vector<size_t>> of_pair; // places in `face` of the lower group's sides
    for (size_t i = 0; i + 1 < face.size(); ++i)
      if (face[i].key == face[i + 1].key) {
        const int32_t a = m_.region[face[i].tet], b = m_.region[face[i + 1].tet];
        if (a != b)
          of_pair[{std::min(a, b) - first_domain, std::max(a, b) - first_domain}].push_back(a < b ? i : i + 1);
      }
    int32_t label = Boundary::box_z1;
    for (const int32_t b : m_.boundary)
      label = std::max(label, b);
    for (const auto& [pair, sides] : of_pair) {
      d.between[++label] = pair;
      for (const size_t i : sides) {
        const Tet& v = m_.tet[face[i].tet];
        const int f = face[i].corner;
        m_.tri.push_back({v[tet_face(f, 0)], v[tet_face(f, 1)], v[tet_face(f, 2)]});
        m_.boundary.push_back(label);
      }
    }
  }

  TetMesh& m_;
  int threads_;
  std::vector<int32_t> owner_; ///< [old points] group; -1: not of region 1
  std::vector<Shares> share_;
  std::vector<int32_t> share_of_; ///< [old points] index into share_
  Starred<2> edge_;
  Starred<3> face_;
  Starred<4> tet_;
  int32_t old_points_ = 0;
};

} // namespace

Division divide(TetMesh& m, const ShareFinder& shares, int threads) {
  return Divider(m, shares, threads).run();
}

} // namespace molmesh::label
