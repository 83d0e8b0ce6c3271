// contour_peers.cpp — density2tet beside CGAL Mesh_3 and TetGen on the same density: elements a second, angles,
// volume. One thread, processor time. Arguments: STRUCTURE SPACING (Å); default the bundled structure, 1 Å.
#include "cgal_mesh.hpp"
#include "contour/contour.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/quality.hpp"
#include "mesh/validity.hpp"
#include "reference/bench/trilinear.hpp"
#include "reference/oracles.hpp"
#include "reference/structure.hpp"
#include <cstdio>
#include <ctime>
#include <functional>

using namespace molmesh;

namespace {

class Stopwatch {
public:
  double seconds() const { return double(std::clock() - start_) / CLOCKS_PER_SEC; }

private:
  std::clock_t start_ = std::clock();
};

void print(const char* name, TetMesh mesh, double seconds) {
  if (mesh.tri.empty())
    rebuild_triangles(mesh, 1);
  const Validity v = check_validity(mesh, 1);
  const Quality q = measure_quality(mesh, 1).all;
  std::string faults;
  for (const Fault& f : v.faults)
    faults += ' ' + f.rule + ' ' + std::to_string(f.count);
  std::printf("%-34s %9zu %8.2f %11.0f %7.2f %7.2f %8.4f %12.1f %6lld  %s\n", name, mesh.tet.size(), seconds,
              double(mesh.tet.size()) / seconds, q.dihedral.min, q.dihedral.max, q.joe_liu_q.min, v.volume,
              static_cast<long long>(v.surface.euler), v.valid() ? "valid" : faults.c_str());
  std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
  const std::string path = argc > 1 ? argv[1] : MOLMESH_SOURCE_DIR "/tests/data/1tii.pdb";
  const double h = argc > 2 ? std::atof(argv[2]) : 1.0;
  const BlockGrid grid = reference::density_of(path, h);
  std::printf("%s, h = %g A\n%-34s %9s %8s %11s %7s %7s %8s %12s %6s\n", path.c_str(), h, "", "tets", "seconds",
              "tets/s", "angles", "", "Q", "volume/A^3", "Euler");
  std::vector<Tri> surface;
  std::vector<Vec3d> surface_points;
  for (double adapt : {0.0, 0.25}) {
    contour::Options options;
    options.adapt = adapt;
    contour::Summary summary;
    const Stopwatch watch;
    const TetMesh m = contour::contour(grid, options, summary, [](const std::string&) {});
    print(adapt == 0 ? "density2tet, uniform" : "density2tet, adapted", m, watch.seconds());
    if (adapt == 0) {
      surface = m.tri;
      surface_points = m.point;
    }
  }
  {
    const std::string volume = std::to_string(h * h * h / 6);
    const Stopwatch watch;
    const TetMesh m = reference::tetgen_fill(surface_points, surface, {}, "q1.4a" + volume);
    print("TetGen on our surface (with cavities)", m, watch.seconds());
  }
  const reference::Trilinear inside(grid);
  for (bool optimized : {false, true}) {
    const Stopwatch watch;
    const TetMesh m = reference::cgal_mesh(std::ref(inside), inside.center(), inside.radius(),
                                           {1.2 * h, 0.25 * h, 1.2 * h, optimized});
    print(optimized ? "CGAL Mesh_3, perturbed and exuded" : "CGAL Mesh_3", m, watch.seconds());
  }
}
