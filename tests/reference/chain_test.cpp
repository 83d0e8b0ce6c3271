// chain_test.cpp — meshes of a real structure: CGAL on the molecular surface, TetGen's fill of it.
#include "contour/contour.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/surface_crossings.hpp"
#include "mesh/validity.hpp"
#include "oracles.hpp"
#include "structure.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;

namespace {

std::vector<Tri> molecular_surface(const TetMesh& m) {
  std::vector<Tri> tri;
  for (size_t t = 0; t < m.tri.size(); ++t)
    if (m.boundary[t] == Boundary::surface)
      tri.push_back(m.tri[t]);
  return tri;
}

} // namespace

TEST_CASE("1TII: the molecular surface is closed, bounds a volume, and does not cross itself, as TetGen sees too") {
  const BlockGrid grid = reference::density_of(MOLMESH_SOURCE_DIR "/tests/data/1tii.pdb", 1.0);
  for (double adapt : {0.0, 0.25}) {
    INFO("adapt " << adapt);
    contour::Summary summary;
    contour::Options options;
    options.meshed = contour::Options::both;
    options.adapt = adapt;
    options.threads = 2;
    const TetMesh m = contour::contour(grid, options, summary, [](const std::string&) {});
    const Validity v = check_validity(m, 2);
    REQUIRE(v.valid());
    REQUIRE(v.region.size() == 3);
    const std::vector<Tri> tri = molecular_surface(m);
    const reference::CgalSurface s = reference::cgal_surface(m.point, tri);
    CHECK(s.manifold);
    CHECK(s.closed);
    CHECK(s.crossings == 0);
    CHECK(find_crossings(m.point, tri, 2).pairs == 0);
    CHECK(s.bounds_volume);
    CHECK(s.components == v.surface.components);
    CHECK(s.euler == v.surface.euler);
    CHECK(s.area == Approx(v.surface.area).epsilon(1e-11));
    CHECK(s.volume == Approx(v.region[0].volume).epsilon(1e-11)); // the molecule's tetrahedra, cavities apart

    TetMesh fill = reference::tetgen_fill(m.point, tri); // cavities too
    rebuild_triangles(fill);
    const Validity filled = check_validity(fill, 2);
    CHECK(filled.volume == Approx(v.region[0].volume + v.region[2].volume).epsilon(1e-9));
  }
}
