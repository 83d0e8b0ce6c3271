// peaks.cu — a copy and chains of multiply-adds, best of a few.
#include "cuda/par/device.cuh"
#include "peaks.hpp"
#include <algorithm>

namespace molmesh::gpu {
namespace {

struct Copy {
  const float4* from;
  float4* to;
  MOLMESH_HD void operator()(int64_t i) const { to[i] = from[i]; }
};

constexpr int steps = 512, chains = 8;

template <class Real>
struct MultiplyAdds {
  Real* out;
  MOLMESH_HD void operator()(int64_t i) const {
    Real v[chains];
    for (int c = 0; c < chains; ++c)
      v[c] = Real(i + c);
    const Real a = Real(0.999), b = Real(1e-3);
    for (int s = 0; s < steps; ++s)
      for (int c = 0; c < chains; ++c)
        v[c] = v[c] * a + b;
    Real sum = 0;
    for (int c = 0; c < chains; ++c)
      sum += v[c];
    out[i] = sum;
  }
};

} // namespace

Peaks measure_peaks() {
  Peaks p;
  constexpr int64_t n = int64_t{1} << 24, threads = int64_t{1} << 22;
  for (int repeat = 0; repeat < 4; ++repeat) {
    cuda::DeviceBackend b(0);
    const auto from = b.filled(n, float4{1, 2, 3, 4}), to = b.filled(n, float4{});
    const auto single = b.filled(threads, 0.0f);
    const auto in_double = b.filled(threads, 0.0);
    b.for_n("copy", n, Copy{from.data(), to.data()});
    b.for_n("single", threads, MultiplyAdds<float>{single.data()});
    b.for_n("double", threads, MultiplyAdds<double>{in_double.data()});
    for (const cuda::KernelTime& t : b.times()) {
      if (t.name == "copy")
        p.bytes = std::max(p.bytes, 2.0 * n * sizeof(float4) / t.seconds);
      if (t.name == "single")
        p.single = std::max(p.single, double(threads) * steps * chains / t.seconds);
      if (t.name == "double")
        p.in_double = std::max(p.in_double, double(threads) * steps * chains / t.seconds);
    }
  }
  return p;
}

} // namespace molmesh::gpu
