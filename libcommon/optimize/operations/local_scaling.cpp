// local_scaling.cpp — the surroundings of a point shrink towards it, and shells take the room.
// Take the elements around a point c out, out to a closed shell whose triangles all face c, and put them back
// contracted towards c: they keep their shapes. Between the shell and its image, and between that and its own image
// where one ratio would be too far, every triangle carries a frustum of three elements, cut by the order of its
// vertices so that neighbours fit. All lie inside the shell and fill it once: nothing outside changes. The surface
// keeps its triangles; where it runs through the shell, it runs on straight to its image. New elements are as small
// as what is there, and only there.
#include "optimize/operations/local_scaling.hpp"
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
std::vector<int32_t> crossed(const std::vector<Core::ShellTriangle>& shell) {
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

std::vector<int32_t> vertices_of(const std::vector<Core::ShellTriangle>& shell) {
  std::vector<int32_t> vertices;
  for (const auto& s : shell)
    vertices.insert(vertices.end(), s.v.begin(), s.v.end());
  par::sort_unique(vertices, 1);
  return vertices;
}

// Where the surface inside touches the shell and does not run through it: it would leave these vertices.
std::vector<int32_t> touched_by_surface(const Region& r, const Core& core) {
  const std::vector<int32_t> on_surface = crossed(core.shell), outer = vertices_of(core.shell);
  std::vector<int32_t> touched;
  for (const int32_t t : core.element) {
    const Element& e = r.mesh.element[t];
    for (size_t f = 0; f < 4; ++f)
      for (size_t i = 0; i < 4 && e.label[f] != 0; ++i)
        if (f != i && is_in(outer, e.v[i]) && !is_in(on_surface, e.v[i]))
          touched.push_back(e.v[i]);
  }
  par::sort_unique(touched, 1);
  return touched;
}

} // namespace

bool find_shell(const Region& r, Core& core, Vec3d c) {
  const auto ends_here = [&](const Element& e, size_t f) {
    return e.n[f] < 0 && (core.through ? r.mesh.labels[e.label[f]].curved() : core.has(outward_triangle(e.v, f)));
  };
  std::vector<int32_t> touched;
  while (core.element.size() <= most_elements) {
    core.shell.clear();
    std::vector<int32_t> more;
    for (const int32_t t : core.element) {
      const Element& e = r.mesh.element[t];
      for (size_t f = 0; f < 4; ++f) {
        if (is_in(core.element, e.n[f]) || ends_here(e, f))
          continue;
        const auto s = outward_triangle(e.v, f);
        const Vec3d p = r.mesh.point[s[0]], n = cross(r.mesh.point[s[1]] - p, r.mesh.point[s[2]] - p);
        const double area = norm(n), height = dot(p - c, n) / area, side = std::sqrt(area);
        const bool surface = e.label[f] != 0;
        const bool may_join = e.n[f] >= 0 && (core.through || !surface) && r.owned(e.n[f]);
        if ((core.through && surface) || !(height > (may_join ? steep : steep_enough) * side) ||
            std::any_of(s.begin(), s.end(), [&](int32_t v) { return is_in(touched, v); })) {
          if (!may_join)
            return false;
          more.push_back(e.n[f]);
        }
        core.shell.push_back({s, e.region});
      }
    }
    if (!more.empty())
      touched.clear();
    else if (!core.through || (touched = touched_by_surface(r, core)).empty())
      return true;
    core.element.insert(core.element.end(), more.begin(), more.end());
    par::sort_unique(core.element, 1);
  }
  return false;
}

bool shrink(Region& r, const Core& core, Vec3d c, double scale, double ratio) {
  std::vector<int32_t>& old = r.work.old;
  std::vector<Candidate>& now = r.work.now;
  const std::vector<int32_t> on_surface = crossed(core.shell), outer = vertices_of(core.shell);
  std::vector<int32_t> inner;
  for (const int32_t v : on_surface)
    if (!r.on_main_target(v))
      return false;
  for (const int32_t t : core.element) {
    const Element& e = r.mesh.element[t];
    for (size_t i = 0; i < 4; ++i) {
      const bool inside = !is_in(outer, e.v[i]);
      const Kind kind = r.mesh.vertex[e.v[i]].kind;
      if (inside && kind != Kind::interior && !(kind == Kind::surface && core.has(e.v[i])))
        return false;
      if (inside)
        inner.push_back(e.v[i]);
    }
  }
  par::sort_unique(inner, 1);
  const auto layers = static_cast<size_t>(std::max(1., std::round(std::log(scale) / std::log(ratio))));
  const size_t fresh = layers * outer.size();
  if (r.room.vertex.size() < fresh || r.room.element.size() < 3 * layers * core.shell.size())
    return false;
  const auto image = [&](int32_t w, size_t layer) {
    const auto i = static_cast<size_t>(std::lower_bound(outer.begin(), outer.end(), w) - outer.begin());
    if (layer == 0 || i == outer.size() || outer[i] != w)
      return w;
    return r.room.vertex[r.room.vertex.size() - 1 - outer.size() * (layer - 1) - i];
  };
  for (size_t layer = 1; layer <= layers; ++layer)
    for (const int32_t w : outer) {
      r.mesh.point[image(w, layer)] = c + std::pow(scale, double(layer) / double(layers)) * (r.mesh.point[w] - c);
      r.mesh.vertex[image(w, layer)] = is_in(on_surface, w) ? r.mesh.vertex[w] : Vertex{};
    }
  const auto leaves_walls = [&](int32_t w, Vec3d from) {
    return r.mesh.vertex[w].kind == Kind::surface && !r.inside_walls(from, r.mesh.point[w]);
  };
  bool out = false;
  for (const int32_t w : on_surface)
    for (size_t layer = 1; layer <= layers; ++layer)
      out = out || leaves_walls(image(w, layer), r.mesh.point[w]);
  std::vector<Vec3d> home;
  for (const int32_t w : inner) {
    home.push_back(r.mesh.point[w]);
    r.mesh.point[w] = c + scale * (home.back() - c);
    out = out || leaves_walls(w, home.back());
  }
  now.clear();
  for (const int32_t t : core.element) {
    now.push_back({r.mesh.element[t].v, r.mesh.element[t].region, 0, {}});
    for (int32_t& w : now.back().v)
      w = image(w, layers);
  }
  for (const auto& s : core.shell)
    for (size_t layer = 1; layer <= layers; ++layer)
      for (const auto& corner : frustum(s.v)) {
        now.push_back({{}, s.region, 0, {}});
        for (size_t i = 0; i < 4; ++i)
          now.back().v[i] = image(s.v[corner[i] % 3], corner[i] < 3 ? layer - 1 : layer);
      }
  old = core.element;
  r.crossings.clear();
  if (out || !std::all_of(now.begin(), now.end(), [&](Candidate& e) { return r.judge(e, 0); }) ||
      !r.exchange(old, now, core.through, true)) {
    for (size_t i = 0; i < inner.size(); ++i)
      r.mesh.point[inner[i]] = home[i];
    return false;
  }
  r.room.vertex.resize(r.room.vertex.size() - fresh);
  return r.done(&Counts::cavity_shrinks, "local scaling");
}

} // namespace molmesh::optimize
