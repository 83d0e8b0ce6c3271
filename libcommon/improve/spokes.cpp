// spokes.cpp — tet_quality over eight lanes in the compiler's own vectors, compiled for AVX2 and for any processor.
#include "improve/spokes.hpp"
#include "improve/spoke_quality.hpp"
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
  const auto corner = [&](int i) { return p[size_t(spoke_corner(moving, i))]; };
  if (scale_ == 0)
    scale_ = std::max(norm(corner(1) - corner(2)), 1e-300);
  const Spoke<float> s = make_spoke(local(corner(1)), local(corner(2)), local(corner(3)));
  const int lane = static_cast<int>(count_++ % lanes);
  if (lane == 0)
    group_.emplace_back();
  Group& g = group_.back();
  for (int l = lane; l < (lane == 0 ? lanes : lane + 1); ++l) { // a fresh group is full of its first element
    const auto i = size_t(l);
    g.ax[i] = s.ax, g.ay[i] = s.ay, g.az[i] = s.az;
    g.bx[i] = s.bx, g.by[i] = s.by, g.bz[i] = s.bz;
    g.cx[i] = s.cx, g.cy[i] = s.cy, g.cz[i] = s.cz;
    g.nx[i] = s.nx, g.ny[i] = s.ny, g.nz[i] = s.nz;
    g.r[i] = s.r;
    g.ab[i] = s.ab, g.bc[i] = s.bc, g.ca[i] = s.ca;
  }
}

MOLMESH_VECTOR_CLONES void Spokes::evaluate(const Group& g, Vec3f x, Lane& out) {
  Spoke<V> s;
  load(g.ax, s.ax), load(g.ay, s.ay), load(g.az, s.az);
  load(g.bx, s.bx), load(g.by, s.by), load(g.bz, s.bz);
  load(g.cx, s.cx), load(g.cy, s.cy), load(g.cz, s.cz);
  load(g.nx, s.nx), load(g.ny, s.ny), load(g.nz, s.nz);
  load(g.r, s.r);
  load(g.ab, s.ab), load(g.bc, s.bc), load(g.ca, s.ca);
  V q;
  spoke_quality(s, x, q);
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
