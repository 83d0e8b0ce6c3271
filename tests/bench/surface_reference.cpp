// surface_reference.cpp — volume and area of the solvent-excluded body of a .hier, by probes all over the atoms and
// counting: for the figures of docs/benchmarks.md.
//
//   surface_reference FILE.hier PROBE LATTICE STEP     Å; LATTICE: between the places that are counted
#include "formats/hier/hier.hpp"
#include "unit/distance/sampled.hpp"
#include <cstdio>
#include <fstream>
#include <random>
#include <string>

using namespace molmesh;

int main(int argc, char** argv) {
  if (argc != 5)
    return 2;
  std::ifstream in(argv[1]);
  const Hierarchy h = formats::read_hier(in, argv[1]);
  const double probe = std::stod(argv[2]), lattice = std::stod(argv[3]), shell = 0.1;
  const test::SampledSurface surface(h, probe, std::stod(argv[4]));
  Vec3d lo = h.atom[0].center, hi = lo;
  for (const Atom& a : h.atom)
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], a.center[k] - a.radius - shell);
      hi[k] = std::max(hi[k], a.center[k] + a.radius + shell);
    }
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0, lattice);
  int64_t inside = 0, inner = 0, outer = 0;
  for (double x = lo.x; x < hi.x; x += lattice)
    for (double y = lo.y; y < hi.y; y += lattice)
      for (double z = lo.z; z < hi.z; z += lattice) {
        const double d = surface.distance(Vec3d{x, y, z} + Vec3d{u(random), u(random), u(random)}, 2 * shell);
        inside += d > 0;
        inner += d > shell;
        outer += d > -shell;
      }
  const double each = lattice * lattice * lattice;
  std::printf("volume %.1f Å³, area %.1f Å²\n", double(inside) * each, double(outer - inner) * each / (2 * shell));
}
