// spokes.cpp — tet_quality over lanes, in the compiler's own vectors.
#include "improve/spokes.hpp"
#include <algorithm>
#include <cstring>

namespace molmesh::improve {
namespace {
constexpr size_t width = 4;
typedef float V __attribute__((vector_size(4 * width))); // GCC and Clang, any processor
} // namespace

void Spokes::add(const std::array<Vec3d, 4>& p, int moving) {
  // Even permutations that bring the moving vertex to the front.
  static constexpr int order[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
  const int* o = order[moving];
  if (scale_ == 0)
    scale_ = std::max(norm(p[size_t(o[1])] - p[size_t(o[2])]), 1e-300);
  const Vec3f a = local(p[size_t(o[1])]), b = local(p[size_t(o[2])]), c = local(p[size_t(o[3])]);
  const Vec3f n = cross(b - a, c - a);
  const int lane = static_cast<int>(count_++ % lanes);
  if (lane == 0)
    group_.emplace_back();
  Group& g = group_.back();
  for (int l = lane; l < (lane == 0 ? lanes : lane + 1); ++l) { // a fresh group is full of its first element
    const auto i = size_t(l);
    g.ax[i] = a.x, g.ay[i] = a.y, g.az[i] = a.z;
    g.bx[i] = b.x, g.by[i] = b.y, g.bz[i] = b.z;
    g.cx[i] = c.x, g.cy[i] = c.y, g.cz[i] = c.z;
    g.nx[i] = n.x, g.ny[i] = n.y, g.nz[i] = n.z;
    g.r[i] = 1 / norm2(n);
    g.ab[i] = norm2(b - a), g.bc[i] = norm2(c - b), g.ca[i] = norm2(a - c);
  }
}

void Spokes::evaluate(const Group& group, Vec3f x, Lane& out) {
  constexpr float w = static_cast<float>(obtuse_weight * obtuse_weight);
  const auto less = [](V a, V b) { return a < b ? a : b; };
  const auto weight = [](V cosine) { return cosine > 0 ? V{} + w : V{} + 1; };
  for (size_t i = 0; i < lanes; i += width) {
    const auto in = [i](const Lane& lane) {
      V v;
      std::memcpy(&v, &lane[i], sizeof v);
      return v;
    };
    const V ax = in(group.ax) - x.x, ay = in(group.ay) - x.y, az = in(group.az) - x.z;
    const V bx = in(group.bx) - x.x, by = in(group.by) - x.y, bz = in(group.bz) - x.z;
    const V cx = in(group.cx) - x.x, cy = in(group.cy) - x.y, cz = in(group.cz) - x.z;
    const V nx = in(group.nx), ny = in(group.ny), nz = in(group.nz), r = in(group.r);
    // Outward normals of the faces opposite a, b, c; n is that of the one opposite the vertex.
    const V ux = cy * bz - cz * by, uy = cz * bx - cx * bz, uz = cx * by - cy * bx;
    const V vx = ay * cz - az * cy, vy = az * cx - ax * cz, vz = ax * cy - ay * cx;
    const V tx = by * az - bz * ay, ty = bz * ax - bx * az, tz = bx * ay - by * ax;
    const V det = -(ax * ux + ay * uy + az * uz);
    const V ru = 1 / (ux * ux + uy * uy + uz * uz), rv = 1 / (vx * vx + vy * vy + vz * vz);
    const V rt = 1 / (tx * tx + ty * ty + tz * tz);
    V s = in(group.bc) * r * ru * weight(nx * ux + ny * uy + nz * uz);
    const V aa = ax * ax + ay * ay + az * az, bb = bx * bx + by * by + bz * bz, cc = cx * cx + cy * cy + cz * cz;
    const V sum = aa + bb + cc + in(group.ab) + in(group.bc) + in(group.ca);
    s = less(s, static_cast<float>(shape_weight) / (sum * sum * sum));
    s = less(s, in(group.ca) * r * rv * weight(nx * vx + ny * vy + nz * vz));
    s = less(s, in(group.ab) * r * rt * weight(nx * tx + ny * ty + nz * tz));
    s = less(s, cc * ru * rv * weight(ux * vx + uy * vy + uz * vz));
    s = less(s, bb * ru * rt * weight(ux * tx + uy * ty + uz * tz));
    s = less(s, aa * rv * rt * weight(vx * tx + vy * ty + vz * tz));
    s = det > 0 ? s * det * det : V{} - 1;
    std::memcpy(&out[i], &s, sizeof s);
  }
}

float Spokes::worst(Vec3d x, float above) {
  const Vec3f y = local(x);
  float w = 2;
  Lane q;
  for (size_t k = 0; k < group_.size(); ++k) {
    evaluate(group_[k], y, q);
    const float least_here = least(q);
    w = least_here < w ? least_here : w;
    if (!(w > above)) {
      if (k > 0)
        std::swap(group_[k], group_[k - 1]);
      return w;
    }
  }
  return w;
}

Vec3d Spokes::ascent(Vec3d x, double step) {
  const Vec3f y = local(x);
  const float d = static_cast<float>(step / scale_);
  size_t group = 0, lane = 0;
  float w = 2;
  Lane q, plus, minus;
  for (size_t k = 0; k < group_.size(); ++k) {
    evaluate(group_[k], y, q);
    for (size_t l = 0; l < lanes; ++l)
      if (q[l] < w)
        w = q[l], group = k, lane = l;
  }
  Vec3d g;
  for (int a = 0; a < 3; ++a) {
    Vec3f u = y, v = y;
    u[a] += d;
    v[a] -= d;
    evaluate(group_[group], u, plus);
    evaluate(group_[group], v, minus);
    g[a] = double(plus[lane]) - double(minus[lane]);
  }
  const double length = norm(g);
  return length > 0 ? g / length : Vec3d{};
}

} // namespace molmesh::improve
