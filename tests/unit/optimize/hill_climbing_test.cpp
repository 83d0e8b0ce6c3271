// hill_climbing_test.cpp — points in gaps and spikes narrower than the grid, where repair by itself gets stuck.
#include "lattice_mesh.hpp"
#include "optimize/optimize.hpp"
#include "surface_shape.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;

namespace {

constexpr double h = 0.5;

} // namespace

TEST_CASE("points come back where repair alone leaves elements below the goal", "[slow]") {
  // Each needs what is bad after a trial to be made worse before it is better.
  enum Kind { gap, spike };
  struct Narrow {
    Kind kind;
    double a, b, c, d;
  };
  const Narrow k = GENERATE(Narrow{gap, 0.787139, 0.713566, 0.023118, 0.315767},
                            Narrow{spike, 0.808929, 0.398991, 0.424702, 0.413719},
                            Narrow{spike, 0.193356, 0.100474, 0.482637, 0.613703},
                            Narrow{spike, 0.161364, 0.328523, 0.169865, 0.837378}); // the surface bends
  CAPTURE(k.kind, k.a);
  const Vec3d way = Vec3d{k.c - 0.5, k.d - 0.5, k.a - 0.3} / norm(Vec3d{k.c - 0.5, k.d - 0.5, k.a - 0.3});
  const Vec3d middle{5 + 0.3 * k.a, 5 - 0.3 * k.b, 5 + 0.3 * k.c};
  const double width = (0.03 + 0.3 * k.d) * h, slope = 0.1 + 0.3 * k.b;
  const Field field = [&](Vec3d p) {
    const Vec3d x = p - middle;
    const double along = dot(x, way), across = norm(x - along * way), ball = 4.6 * h - norm(x);
    const auto half = [&](double side) { return 2.6 * h - norm(x - side * (2.6 * h + width) * way); };
    return std::exp(0.5 * (k.kind == gap ? std::max(half(1), half(-1))
                                         : std::min(ball, across - std::max(0., slope * (along + h)) + 0.02 * h)));
  };
  const BlockGrid grid = lattice_grid(field, {0, 0, 0}, h, 20);
  TetMesh mesh = lattice_mesh(field, {0, 0, 0}, h, 20), helped = mesh;
  const int64_t shape = surface_shape(mesh).euler();
  const optimize::Result result = optimize::improve(mesh, &grid, {});
  CHECK(result.fidelity.points_off == 0);
  CHECK(result.after.min >= 25);
  CHECK(result.after.max <= 140);
  CHECK(surface_shape(mesh).euler() == shape);
  CHECK_NOTHROW(optimize::build(mesh, 180, 1));
  optimize::Options three; // threads, two of which try what comes next
  three.threads = 3;
  optimize::improve(helped, &grid, three);
  CHECK(helped.point == mesh.point);
  CHECK(helped.tet == mesh.tet);
  CHECK(helped.region == mesh.region);
}
