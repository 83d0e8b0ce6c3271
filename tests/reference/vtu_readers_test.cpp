// vtu_readers_test.cpp — VTK and meshio read from our .vtu what was written.
#include "formats/vtu/vtu.hpp"
#include "unit/mesh/meshes.hpp"
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sys/wait.h>
#include <unistd.h>

using namespace molmesh;
using namespace molmesh::testing;
namespace fs = std::filesystem;

namespace {

nlohmann::json expected(const TetMesh& m) {
  nlohmann::json j;
  std::vector<double> points;
  for (const Vec3d& p : m.point)
    points.insert(points.end(), {p.x, p.y, p.z});
  std::vector<int32_t> connectivity, types, region, boundary, part;
  for (size_t i = 0; i < m.tet.size(); ++i) {
    connectivity.insert(connectivity.end(), m.tet[i].begin(), m.tet[i].end());
    types.push_back(10);
    region.push_back(m.region[i]);
    boundary.push_back(0);
    if (!m.part.empty())
      part.push_back(m.part[i]);
  }
  for (size_t t = 0; t < m.tri.size(); ++t) {
    connectivity.insert(connectivity.end(), m.tri[t].begin(), m.tri[t].end());
    types.push_back(5);
    region.push_back(0);
    boundary.push_back(m.boundary[t]);
    if (!m.part.empty())
      part.push_back(0);
  }
  nlohmann::json arrays = nlohmann::json::object(), texts = nlohmann::json::object();
  for (const CellArray& a : m.cell_array)
    a.real.empty() ? arrays[a.name] = a.integer : arrays[a.name] = a.real;
  for (const NamedText& t : m.named_text)
    texts[t.name] = t.text;
  return {{"arrays", arrays},       {"texts", texts},     {"points", points},     {"connectivity", connectivity},
          {"types", types},         {"region", region},   {"boundary", boundary}, {"part", part},
          {"isovalue", m.isovalue}, {"source", m.source}, {"creator", m.creator}};
}

void read_by(const char* program, const char* needs) {
  const fs::path folder = fs::temp_directory_path() / ("molmesh_vtu." + std::to_string(getpid()));
  fs::create_directories(folder);
  std::mt19937_64 random(21);
  for (int n = 0; n < 40; ++n) { // sizes of all kinds: offsets of the blocks must not be mixed up
    TetMesh m = cubes(1 + n % 4, [&](Vec3i) { return int32_t(random() % 3 + 1); });
    for (Vec3d& p : m.point)
      p = {p.x + 1e-9 * double(random() % 1000), p.y / 3, -p.z};
    m.tri.resize(random() % m.tri.size() + 1);
    m.boundary.resize(m.tri.size());
    if (n % 2)
      for (size_t i = 0; i < m.tet.size(); ++i)
        m.part.push_back(int32_t(random() % 5));
    for (int a = 0; a < n % 5; ++a) {
      CellArray array{"array " + std::to_string(a), {}, {}};
      for (size_t c = 0; c < m.tet.size() + m.tri.size(); ++c)
        a % 2 ? array.real.push_back(double(random() % 1000) / 7)
              : array.integer.push_back(int32_t(random() % 100) - 50);
      m.cell_array.push_back(array);
      m.named_text.push_back({"text_" + std::to_string(a), std::string(random() % 50 + 1, 'y') + "\n"});
    }
    m.isovalue = double(random() % 100) / 7;
    m.source = std::string(random() % 40 + 1, 'x') + " \xc3\xa9<&>_";
    m.creator = "density2tet 0.1.0";
    const fs::path stem = folder / std::to_string(n);
    std::ofstream file(stem.string() + ".vtu", std::ios::binary);
    formats::write_vtu(file, m);
    std::ofstream(stem.string() + ".json") << expected(m);
  }
  const std::string log = (folder / "log").string();
  const std::string command = std::string("/usr/bin/python3 " MOLMESH_SOURCE_DIR "/tests/reference/read_vtu.py ") +
                              program + " " + folder.string() + " > " + log + " 2>&1";
  const int status = std::system(command.c_str());
  std::ifstream in(log);
  INFO(std::string(std::istreambuf_iterator<char>(in), {}));
  if (WEXITSTATUS(status) == 77 || WEXITSTATUS(status) == 127)
    WARN("skipped: needs " << needs);
  else
    CHECK(status == 0);
  fs::remove_all(folder);
}

} // namespace

TEST_CASE("meshio reads our files, whatever their sizes") {
  read_by("meshio", "/usr/bin/python3 with python3-meshio");
}

TEST_CASE("VTK reads our files, whatever their sizes") {
  read_by("vtk", "/usr/bin/python3 with python3-vtk9");
}
