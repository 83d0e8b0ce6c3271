// mcsf_fetk_test.cpp — MC, the solver that defines the format, reads what we write as .m and finds it conforming.
#include "formats/mcsf/mcsf.hpp"
#include "formats/vtu/names.hpp"
#include "mesh/adjacency.hpp"
#include "unit/mesh/meshes.hpp"
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <mc/gem.h>
#include <unistd.h>

using namespace molmesh;

TEST_CASE("MC reads .m: points, materials, boundary types, and its own check of the mesh passes") {
  TetMesh m = testing::cubes(
      4, [](Vec3i p) { return p.x > 0 && p.x < 3 && p.y > 0 && p.y < 3 && p.z > 0 && p.z < 3 ? 1 : 2; }, 1.0 / 3);
  bool outside_only = false;
  SECTION("both regions") {}
  SECTION("the outside alone, its inner boundary a patch") {
    m = testing::extract(m, [](int32_t r) { return r == 2; });
    CellArray patch{"patch", std::vector<int32_t>(m.tet.size(), 0), {}};
    for (size_t t = 0; t < m.tri.size(); ++t)
      patch.integer.push_back(m.boundary[t] == 1 && t % 2 ? 8 : m.boundary[t]);
    m.cell_array = {patch};
    outside_only = true;
  }
  const std::string path =
      (std::filesystem::temp_directory_path() / ("molmesh_mcsf." + std::to_string(getpid()) + ".m")).string();
  {
    std::ofstream out(path);
    formats::write_mcsf(out, m, "x.vtu");
  }
  Vio_start();
  Gem* gem = Gem_ctor(nullptr, PDE_ctor_default());
  Vio* file = Vio_ctor("FILE", "ASC", nullptr, path.c_str(), "r");
  REQUIRE(file != nullptr);
  REQUIRE(Vio_accept(file, 0) >= 0);
  REQUIRE(Gem_read(gem, 0, file) == 1);
  Vio_acceptFree(file);
  Vio_dtor(&file);
  std::filesystem::remove(path);
  Gem_formChk(gem, 3); // ends the program when something is wrong
  REQUIRE(Gem_dim(gem) == 3);
  REQUIRE(Gem_numVV(gem) == int(m.point.size()));
  REQUIRE(Gem_numSS(gem) == int(m.tet.size()));
  for (size_t p = 0; p < m.point.size(); ++p)
    for (int a = 0; a < 3; ++a)
      CHECK(VV_coord(Gem_VV(gem, int(p)), a) == m.point[p][a]);
  const std::vector<int32_t> patch = formats::export_labels(m).patch;
  int64_t outer[19] = {}, found[19] = {};
  for (size_t t = 0; t < m.tri.size(); ++t)
    if (m.boundary[t] > 1 || outside_only)
      ++outer[patch[t]];
  for (size_t t = 0; t < m.tet.size(); ++t) {
    SS* simplex = Gem_SS(gem, int(t));
    CHECK(SS_type(simplex) == unsigned(m.region[t]));
    for (int c = 0; c < 4; ++c) {
      CHECK(VV_id(SS_vertex(simplex, c)) == unsigned(m.tet[t][c]));
      if (const unsigned type = SS_faceType(simplex, c)) {
        CHECK(VDIRICHLET(type) == (type != 22));
        ++found[(type + 1) / 2];
      }
    }
  }
  for (int label = 0; label < 19; ++label)
    CHECK(found[label] == outer[label]);
  Gem_dtor(&gem);
}
