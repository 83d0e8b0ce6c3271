// local_scaling.cpp — the surroundings of a point shrink towards it, and shells take the room.
// Take the elements around a point c out, out to a closed shell whose triangles all face c, and put them back
// contracted towards c: they keep their shapes. Between the shell and its image, and between that and its own image
// where one ratio would be too far, every triangle carries a frustum of three elements, cut by the order of its
// vertices so that neighbours fit. All lie inside the shell and fill it once: nothing outside changes. The surface
// keeps its triangles; where it runs through the shell, it runs on straight to its image. New elements are as small
// as what is there, and only there.
#include "optimize/operations/editor.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::optimize {
namespace {

constexpr size_t most_elements = 1000; // inside the shell
constexpr double steep = 0.3,
                 steep_enough = 0.02; // height of a shell's triangle over c by the root of twice its area

bool is_in(const std::vector<int32_t>& sorted, int32_t x) {
  return std::binary_search(sorted.begin(), sorted.end(), x);
}

// Elements of the frustum from an outward triangle v (corners 0 to 2) to its image (3 to 5).
std::array<std::array<size_t, 4>, 3> frustum(const std::array<int32_t, 3>& v) {
  std::array<size_t, 3> o{0, 1, 2};
  bool odd = false;
  const auto order = [&](size_t i, size_t j) {
    if (v[o[i]] > v[o[j]])
      std::swap(o[i], o[j]), odd = !odd;
  };
  order(0, 1), order(1, 2), order(0, 1);
  std::array<std::array<size_t, 4>, 3> all{
      {{o[0], o[1], o[2], o[2] + 3}, {o[0], o[1] + 3, o[1], o[2] + 3}, {o[0], o[0] + 3, o[1] + 3, o[2] + 3}}};
  if (!odd) // the image lies behind
    for (auto& e : all)
      std::swap(e[0], e[1]);
  return all;
}

// Vertices where the surface runs through the shell: where its triangles change region, or end.
std::vector<int32_t> crossed(const std::vector<Piece::ShellTriangle>& shell) {
  std::vector<std::array<int32_t, 3>> side; // edge as its triangle runs, region
  for (const auto& s : shell)
    for (size_t i = 0; i < 3; ++i)
      side.push_back({s.v[i], s.v[(i + 1) % 3], s.region});
  std::sort(side.begin(), side.end());
  std::vector<int32_t> vertices;
  for (const auto& [a, b, region] : side)
    if (!std::binary_search(side.begin(), side.end(), std::array<int32_t, 3>{b, a, region}))
      vertices.insert(vertices.end(), {a, b});
  par::sort_unique(vertices, 1);
  return vertices;
}

} // namespace

// Elements join the piece's beyond triangles that do not face c, or that the surface may not be left at, until
// there are none; then those triangles are the shell.
bool Editor::find_shell(Piece& piece, Vec3d c) {
  const auto ends_here = [&](const Element& e, size_t f) {
    return e.n[f] < 0 && (piece.through ? m_.labels[e.label[f]].curved() : piece.has(outward_triangle(e.v, f)));
  };
  while (piece.element.size() <= most_elements) {
    piece.shell.clear();
    std::vector<int32_t> more;
    for (const int32_t t : piece.element) {
      const Element& e = m_.element[t];
      for (size_t f = 0; f < 4; ++f) {
        if (is_in(piece.element, e.n[f]) || ends_here(e, f))
          continue;
        const auto s = outward_triangle(e.v, f);
        const Vec3d p = m_.point[s[0]], n = cross(m_.point[s[1]] - p, m_.point[s[2]] - p);
        const double area = norm(n), height = dot(p - c, n) / area, side = std::sqrt(area);
        const bool surface = e.label[f] != 0;
        const bool may_join = e.n[f] >= 0 && (piece.through || !surface) && owned(e.n[f]);
        if ((piece.through && surface) || !(height > (may_join ? steep : steep_enough) * side)) {
          if (!may_join)
            return false;
          more.push_back(e.n[f]);
        }
        piece.shell.push_back({s, e.region});
      }
    }
    if (more.empty())
      return true;
    piece.element.insert(piece.element.end(), more.begin(), more.end());
    par::sort_unique(piece.element, 1);
  }
  return false;
}

// To `scale`, with shells smaller by about `ratio` each. False, and nothing changed, when that cannot be.
bool Editor::shrink(const Piece& piece, Vec3d c, double scale, double ratio) {
  std::vector<int32_t> outer, inner; // of the shell; inside
  const std::vector<int32_t> on_surface = crossed(piece.shell);
  for (const auto& s : piece.shell)
    outer.insert(outer.end(), s.v.begin(), s.v.end());
  par::sort_unique(outer, 1);
  for (const int32_t v : on_surface)
    if (m_.vertex[v].kind != Kind::surface)
      return false;
  for (const int32_t t : piece.element) {
    const Element& e = m_.element[t];
    for (size_t i = 0; i < 4; ++i) {
      const bool inside = !is_in(outer, e.v[i]);
      const Kind kind = m_.vertex[e.v[i]].kind;
      if (inside && kind != Kind::interior && !(kind == Kind::surface && piece.has(e.v[i])))
        return false;
      if (inside)
        inner.push_back(e.v[i]);
      for (size_t f = 0; f < 4 && piece.through && !inside && !is_in(on_surface, e.v[i]); ++f)
        if (f != i && e.label[f] != 0)
          return false; // the surface touches the shell here, and would leave it
    }
  }
  par::sort_unique(inner, 1);
  const auto layers = static_cast<size_t>(std::max(1., std::round(std::log(scale) / std::log(ratio))));
  const size_t fresh = layers * outer.size();
  if (room_.vertex.size() < fresh || room_.element.size() < 3 * layers * piece.shell.size())
    return false;
  const auto image = [&](int32_t w, size_t layer) {
    const auto i = static_cast<size_t>(std::lower_bound(outer.begin(), outer.end(), w) - outer.begin());
    if (layer == 0 || i == outer.size() || outer[i] != w)
      return w;
    return room_.vertex[room_.vertex.size() - 1 - outer.size() * (layer - 1) - i];
  };
  for (size_t layer = 1; layer <= layers; ++layer)
    for (const int32_t w : outer) {
      m_.point[image(w, layer)] = c + std::pow(scale, double(layer) / double(layers)) * (m_.point[w] - c);
      m_.vertex[image(w, layer)] = is_in(on_surface, w) ? m_.vertex[w] : Vertex{};
    }
  const auto leaves_walls = [&](int32_t w, Vec3d from) {
    return m_.vertex[w].kind == Kind::surface && !inside_walls(from, m_.point[w]);
  };
  bool out = false;
  for (const int32_t w : on_surface)
    for (size_t layer = 1; layer <= layers; ++layer)
      out = out || leaves_walls(image(w, layer), m_.point[w]);
  std::vector<Vec3d> home;
  for (const int32_t w : inner) {
    home.push_back(m_.point[w]);
    m_.point[w] = c + scale * (home.back() - c);
    out = out || leaves_walls(w, home.back());
  }
  now_.clear();
  for (const int32_t t : piece.element) {
    now_.push_back({m_.element[t].v, m_.element[t].region, 0, {}});
    for (int32_t& w : now_.back().v)
      w = image(w, layers);
  }
  for (const auto& s : piece.shell)
    for (size_t layer = 1; layer <= layers; ++layer)
      for (const auto& corner : frustum(s.v)) {
        now_.push_back({{}, s.region, 0, {}});
        for (size_t i = 0; i < 4; ++i)
          now_.back().v[i] = image(s.v[corner[i] % 3], corner[i] < 3 ? layer - 1 : layer);
      }
  old_ = piece.element;
  clear_rim();
  if (out || !std::all_of(now_.begin(), now_.end(), [&](Candidate& e) { return judge(e, 0); }) ||
      !replace(old_, now_, piece.through, true)) {
    for (size_t i = 0; i < inner.size(); ++i)
      m_.point[inner[i]] = home[i];
    return false;
  }
  room_.vertex.resize(room_.vertex.size() - fresh);
  ++counts.nestings;
  return true;
}

} // namespace molmesh::optimize
