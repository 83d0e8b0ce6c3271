// spokes.cpp — tet_quality over eight lanes in the compiler's own vectors, compiled for AVX2 and for any processor.
#include "improve/spokes.hpp"
#include <algorithm>
#include <cstring>

namespace molmesh::improve {
namespace {

typedef float V __attribute__((vector_size(32))); // GCC and Clang; two halves where the processor has no AVX2

/// Passed by reference: what an eight-lane argument looks like depends on the processor.
void load(const std::array<float, 8>& lane, V& v) {
  std::memcpy(&v, lane.data(), sizeof v);
}

} // namespace

#if defined(__x86_64__) && defined(__linux__)
#define MOLMESH_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define MOLMESH_VECTOR_CLONES
#endif

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

MOLMESH_VECTOR_CLONES void Spokes::evaluate(const Group& g, Vec3f x, Lane& out) {
  V ax, ay, az, bx, by, bz, cx, cy, cz, nx, ny, nz, r, ab, bc, ca;
  load(g.ax, ax), load(g.ay, ay), load(g.az, az);
  load(g.bx, bx), load(g.by, by), load(g.bz, bz);
  load(g.cx, cx), load(g.cy, cy), load(g.cz, cz);
  load(g.nx, nx), load(g.ny, ny), load(g.nz, nz);
  load(g.r, r), load(g.ab, ab), load(g.bc, bc), load(g.ca, ca);
  ax -= x.x, ay -= x.y, az -= x.z;
  bx -= x.x, by -= x.y, bz -= x.z;
  cx -= x.x, cy -= x.y, cz -= x.z;
  // Outward normals of the faces opposite a, b, c; n is that of the one opposite the vertex.
  const V ux = cy * bz - cz * by, uy = cz * bx - cx * bz, uz = cx * by - cy * bx;
  const V vx = ay * cz - az * cy, vy = az * cx - ax * cz, vz = ax * cy - ay * cx;
  const V tx = by * az - bz * ay, ty = bz * ax - bx * az, tz = bx * ay - by * ax;
  const V det = -(ax * ux + ay * uy + az * uz);
  const V ru = 1 / (ux * ux + uy * uy + uz * uz), rv = 1 / (vx * vx + vy * vy + vz * vz);
  const V rt = 1 / (tx * tx + ty * ty + tz * tz);
  constexpr float obtuse = static_cast<float>(obtuse_weight * obtuse_weight);
  const V one = V{} + 1, w = V{} + obtuse;
  const V s0 = bc * r * ru * (nx * ux + ny * uy + nz * uz > 0 ? w : one);
  const V s1 = ca * r * rv * (nx * vx + ny * vy + nz * vz > 0 ? w : one);
  const V s2 = ab * r * rt * (nx * tx + ny * ty + nz * tz > 0 ? w : one);
  const V aa = ax * ax + ay * ay + az * az, bb = bx * bx + by * by + bz * bz, cc = cx * cx + cy * cy + cz * cz;
  const V sum = aa + bb + cc + ab + bc + ca, shape = static_cast<float>(shape_weight) / (sum * sum * sum);
  const V s3 = cc * ru * rv * (ux * vx + uy * vy + uz * vz > 0 ? w : one);
  const V s4 = bb * ru * rt * (ux * tx + uy * ty + uz * tz > 0 ? w : one);
  const V s5 = aa * rv * rt * (vx * tx + vy * ty + vz * tz > 0 ? w : one);
  const V s01 = s0 < s1 ? s0 : s1, s23 = s2 < s3 ? s2 : s3, s45 = s4 < s5 ? s4 : s5;
  const V s03 = s01 < s23 ? s01 : s23, s6 = s45 < shape ? s45 : shape, s = s03 < s6 ? s03 : s6;
  const V q = det > 0 ? s * det * det : V{} - 1;
  std::memcpy(out.data(), &q, sizeof q);
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
