// nest.cpp — a closed surface smaller than the grid comes to the target's size and place, in shells of its own
// surroundings.
// Take the elements around it out, out to a closed shell whose triangles all face one point c, and put them back
// contracted towards c: they keep their shapes. Between the shell and its image, and between that and its own image
// where one ratio would be too far, every triangle carries a frustum of three elements, cut by the order of its
// vertices so that neighbours fit. All lie inside the shell and fill it once: nothing outside changes, and the
// surface keeps its triangles. New elements are as small as what is there, and only there.
#include "improve/editor.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::improve {
namespace {

constexpr size_t most_vertices = 24, most_elements = 1000; // of the surface, which else has room; inside the shell
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

} // namespace

// The closed surface that v is on and the elements at it. False where it is large or not all of this part.
bool Editor::find_piece(int32_t v, Piece& piece) {
  piece.vertex.push_back(v);
  for (size_t i = 0; i < piece.vertex.size(); ++i) {
    const int32_t w = piece.vertex[i];
    if (piece.vertex.size() > most_vertices || m_.vertex[size_t(w)].kind != Kind::surface || !star(w, star_))
      return false;
    piece.element.insert(piece.element.end(), star_.begin(), star_.end());
    for (const int32_t t : star_) {
      const Element& e = m_.element[size_t(t)];
      for (size_t f = 0; f < 4; ++f)
        for (size_t k = 0; k < 4; ++k)
          if (e.label[f] != 0 && e.v[f] != w && k != f && !piece.has(e.v[k]))
            piece.vertex.push_back(e.v[k]);
    }
  }
  par::sort_unique(piece.element, 1);
  double volume = 0; // six times, negative where the molecule is around it
  const Vec3d home = m_.point[size_t(v)];
  for (const int32_t w : piece.vertex)
    piece.centre += m_.point[size_t(w)] / double(piece.vertex.size());
  for (const int32_t t : piece.element) {
    const Element& e = m_.element[size_t(t)];
    for (size_t f = 0; f < 4; ++f)
      if (const auto s = outward_triangle(e.v, f); piece.has(s) && m_.counts_here(e, f)) {
        const auto p = [&](size_t k) { return m_.point[size_t(s[k])] - home; };
        volume += (outward(e, f) ? 1 : -1) * dot(p(0), cross(p(1), p(2)));
      }
  }
  piece.hole = volume < 0;
  return true;
}

// How small the piece has to be, and where, to lie on the target around `to`: as large as it may.
bool Editor::fit_piece(const Piece& piece, Vec3d& to, double& scale) const {
  const double h = target_->spacing();
  const auto most_off = [&](Vec3d at, double s) {
    double most = 0;
    for (const int32_t w : piece.vertex)
      most = std::max(most, off_at(at + s * (m_.point[size_t(w)] - piece.centre)).value_or(1e30));
    return most;
  };
  double best = 1e30;
  const Vec3d from = to;
  for (double s = 1; s > 0.005 && best > 0.8; s *= 0.9) {
    Vec3d x = from;
    double now = most_off(x, s);
    for (double step = 0.2 * h; step > 1e-3 * h; step *= 0.5)
      for (bool again = true; again;) {
        again = false;
        for (int d = 0; d < 6; ++d) {
          Vec3d y = x;
          y[d / 2] += d % 2 ? step : -step;
          if (const double off = most_off(y, s); off < 0.99 * now)
            now = off, x = y, again = true;
        }
      }
    if (now < best)
      best = now, to = x, scale = s;
  }
  return scale < 0.9;
}

// Elements join the piece's beyond triangles that do not face c, until all do; then those triangles are the shell.
bool Editor::find_shell(Piece& piece, Vec3d c) {
  while (piece.element.size() <= most_elements) {
    piece.shell.clear();
    std::vector<int32_t> more;
    for (const int32_t t : piece.element) {
      const Element& e = m_.element[size_t(t)];
      for (size_t f = 0; f < 4; ++f) {
        const auto s = outward_triangle(e.v, f);
        if (is_in(piece.element, e.n[f]) || (e.n[f] < 0 && piece.has(s)))
          continue;
        const Vec3d p = m_.point[size_t(s[0])], n = cross(m_.point[size_t(s[1])] - p, m_.point[size_t(s[2])] - p);
        const double area = norm(n), height = dot(p - c, n) / area, side = std::sqrt(area);
        const bool may_join = e.n[f] >= 0 && e.label[f] == 0 && owned(e.n[f]);
        if (!(height > (may_join ? steep : steep_enough) * side)) {
          if (!may_join)
            return false;
          more.push_back(e.n[f]);
        }
        piece.shell.push_back(s);
        piece.region = e.region;
      }
    }
    if (more.empty())
      return true;
    piece.element.insert(piece.element.end(), more.begin(), more.end());
    par::sort_unique(piece.element, 1);
  }
  return false;
}

bool Editor::nest(int32_t v, double ratio) {
  Piece piece;
  if (!target_ || !find_piece(v, piece))
    return false;
  Vec3d to = piece.centre;
  double scale = 1;
  if (!target_->pocket(piece.centre, piece.hole, to) || !fit_piece(piece, to, scale))
    return false;
  const Vec3d c = piece.centre + (to - piece.centre) / (1 - scale);
  if (!find_shell(piece, c))
    return false;
  std::vector<int32_t> outer, inner;
  for (const auto& s : piece.shell)
    outer.insert(outer.end(), s.begin(), s.end());
  par::sort_unique(outer, 1);
  for (const int32_t t : piece.element)
    for (const int32_t w : m_.element[size_t(t)].v)
      if (!is_in(outer, w)) {
        if (m_.vertex[size_t(w)].kind != Kind::interior && !piece.has(w))
          return false;
        inner.push_back(w);
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
      m_.point[size_t(image(w, layer))] =
          c + std::pow(scale, double(layer) / double(layers)) * (m_.point[size_t(w)] - c);
      m_.vertex[size_t(image(w, layer))] = {};
    }
  std::vector<Vec3d> home;
  for (const int32_t w : inner) {
    home.push_back(m_.point[size_t(w)]);
    m_.point[size_t(w)] = c + scale * (home.back() - c);
  }
  now_.clear();
  for (const int32_t t : piece.element) {
    now_.push_back({m_.element[size_t(t)].v, m_.element[size_t(t)].region, 0, {}});
    for (int32_t& w : now_.back().v)
      w = image(w, layers);
  }
  for (const auto& s : piece.shell)
    for (size_t layer = 1; layer <= layers; ++layer)
      for (const auto& corner : frustum(s)) {
        now_.push_back({{}, piece.region, 0, {}});
        for (size_t i = 0; i < 4; ++i)
          now_.back().v[i] = image(s[corner[i] % 3], corner[i] < 3 ? layer - 1 : layer);
      }
  old_ = piece.element;
  rim_.clear();
  if (!std::all_of(now_.begin(), now_.end(), [&](Candidate& e) { return judge(e, 0); }) ||
      !replace(old_, now_, false, true)) {
    for (size_t i = 0; i < inner.size(); ++i)
      m_.point[size_t(inner[i])] = home[i];
    return false;
  }
  room_.vertex.resize(room_.vertex.size() - fresh);
  ++counts.nestings;
  return true;
}

} // namespace molmesh::improve
