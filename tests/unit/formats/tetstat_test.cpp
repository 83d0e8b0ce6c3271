// tetstat_test.cpp — the report's keys and figures, in JSON and in text.
#include "formats/tetstat/bodies.hpp"
#include "formats/tetstat/layout.hpp"
#include "formats/tetstat/tetstat.hpp"
#include "unit/mesh/meshes.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

using namespace molmesh;
using namespace molmesh::testing;

namespace {

formats::MeshReport report(const TetMesh& m, AngleLimits asked = {}) {
  return formats::report_mesh(m, "x.vtu", {}, check_validity(m, 1), asked, 1);
}
nlohmann::ordered_json json_of(const formats::MeshReport& r) {
  return nlohmann::ordered_json::parse(formats::tetstat_json(r));
}
bool has(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

TetMesh block() {
  TetMesh m = cubes(
      4,
      [](Vec3i c) -> int32_t {
        return c == Vec3i{1, 1, 1} ? Region::molecule : Region::outside;
      },
      20);
  m.source = "two\nlines";
  return m;
}

} // namespace

TEST_CASE("a valid mesh in JSON") {
  const auto j = json_of(report(block()));
  CHECK(j.begin().key() == "tetstat");
  CHECK(j["valid"] == true);
  CHECK(j["faults"].empty());
  CHECK(j["asked"]["met"] == true);
  CHECK(j["tets"] == 384);
  CHECK(j["volume"] == Approx(512'000));
  CHECK(j["regions"][0]["volume"] == Approx(8000));
  CHECK(j["regions"][0]["boundary"]["area"] == Approx(2400));
  CHECK(j["regions"][1]["boundary"]["components"] == 2);
  CHECK(j["surface"]["euler"] == 2);
  CHECK(j["labels"].size() == 7);
  CHECK(j["labels"][6]["triangles"] == 32);
  CHECK(j["quality"]["dihedral"]["histogram"]["counts"][9] == 2 * 384); // 45° to 50°
  CHECK(j["quality"]["dihedral"]["min"] == Approx(45));
}

TEST_CASE("what is asked for and met but for rounding is met") {
  const TetMesh m = cubes(
      3, [](Vec3i) -> int32_t { return Region::molecule; }, 0.1);
  const auto j = json_of(report(m, {45, 90}));
  CHECK(j["asked"]["met"] == true);
  const auto& counts = j["quality"]["dihedral"]["histogram"]["counts"]; // Kuhn's tetrahedra: 45°, 60° and 90°
  CHECK(counts[9] == 2 * 162);
  CHECK(counts[12] == 162);
  CHECK(counts[18] == 3 * 162);
  CHECK(json_of(report(m, {45.001, 90}))["asked"]["met"] == false);
}

TEST_CASE("a surface with more triangles one way than the other along an edge encloses no volume") {
  // Two blocks side by side in one mesh, labels as a foreign file has them: the wall between them is there once.
  TetMesh m = cubes(2, [](Vec3i c) -> int32_t { return c.x < 1 ? Region::molecule : Region::outside; });
  std::fill(m.boundary.begin(), m.boundary.end(), Boundary::surface);
  const Validity v = check_validity(m, 1);
  CHECK(std::isnan(v.surface.volume));
  CHECK(v.surface.faults.crowded_edges == 8);
}

TEST_CASE("a surface that the box cuts encloses no volume") {
  const auto wall_to_wall = [](Vec3i c) -> int32_t { return c.x < 2 ? Region::molecule : Region::outside; };
  const formats::MeshReport r = report(cubes(4, wall_to_wall, 20));
  const auto j = json_of(r);
  CHECK(j["valid"] == true);
  CHECK(j["surface"]["area"] == Approx(6400));
  CHECK(j["surface"]["volume"].is_null());
  CHECK(j["regions"][0]["boundary"]["volume"] == Approx(256'000));
  CHECK(has(formats::tetstat_text(r), "surface        32 triangles                -       6,400.00"));
  const std::string both = formats::compare_text(r, r);
  CHECK(has(both, "-                -\n"));
  CHECK_FALSE(has(both, "nan"));
}

TEST_CASE("quality asked for") {
  CHECK(report(block(), {44.9, 90.1}).good());
  const formats::MeshReport below = report(block(), {50, 180});
  CHECK_FALSE(below.good());
  CHECK(json_of(below)["quality"]["outside"] == 384);
  CHECK(has(formats::tetstat_text(below),
            "BELOW THE QUALITY ASKED FOR: 384 tetrahedra with angles outside 50° to 180°"));
}

TEST_CASE("broken rules are named in both forms") {
  TetMesh m = block();
  std::swap(m.tri[0][0], m.tri[0][1]);
  const formats::MeshReport r = report(m);
  const auto j = json_of(r);
  CHECK(j["valid"] == false);
  CHECK(j["faults"][0]["rule"] == "triangle_orientation");
  CHECK(j["faults"][0]["count"] == 1);
  CHECK(has(j["faults"][0]["example"].get<std::string>().c_str(), "triangle 0 (points "));
  CHECK(has(formats::tetstat_text(r), "INVALID\n  triangle_orientation            1   triangle 0 (points "));
  m.tet[3][1] = -5;
  const auto broken = json_of(report(m));
  CHECK(broken["faults"][0]["rule"] == "index");
  CHECK_FALSE(broken.contains("quality"));
  CHECK(has(formats::tetstat_text(report(m)), "index"));
}

TEST_CASE("text is for people: grouped digits, no control characters, only rows with angles") {
  const std::string text = formats::tetstat_text(report(block()));
  CHECK(has(text, "from two?lines\nvalid\n"));
  CHECK(has(text, "512,000.00") == false); // the total stands in the regions
  CHECK(has(text, "504,000.00"));
  CHECK(has(text, "2,400.00"));
  CHECK(has(text, " 40° to  50°"));
  CHECK_FALSE(has(text, "100° to 110°"));
}

TEST_CASE("two meshes side by side") {
  const TetMesh m = block();
  TetMesh larger = m;
  for (Vec3d& p : larger.point)
    p = 1.1 * p;
  larger.tri.pop_back();
  larger.boundary.pop_back();
  const formats::MeshReport a = report(m), b = report(larger);
  const std::string text = formats::compare_text(a, b);
  CHECK(has(text, "yes"));
  CHECK(has(text, "B: missing_triangle 1"));
  CHECK(has(text, "+33.100 %")); // 1.1³
  CHECK(has(text, "+21.000 %")); // 1.1²
  const auto j = nlohmann::ordered_json::parse(formats::compare_json(a, b));
  CHECK(j["a"] == json_of(a));
  CHECK(j["b"]["valid"] == false);
}

TEST_CASE("bodies name the residues of their triangles, those with the most first") {
  TetMesh m = cubes(5, [](Vec3i c) -> int32_t {
    return c == Vec3i{2, 2, 2}                                              ? Region::cavity
           : std::min({c.x, c.y, c.z}) > 0 && std::max({c.x, c.y, c.z}) < 4 ? Region::molecule
                                                                            : Region::outside;
  });
  CHECK_FALSE(has(formats::bodies_text(formats::list_bodies(m, "x.vtu", 1)), "residues"));
  // Residues by height and side; the cavity is the one cube in the middle, between z = 2 and 3.
  CellArray residue{"residue", std::vector<int32_t>(m.tet.size(), -1), {}};
  for (size_t i = 0; i < m.tri.size(); ++i) {
    const Vec3d at = cell_centroid(m, m.tet.size() + i);
    residue.integer.push_back(m.boundary[i] != Boundary::surface ? -1
                              : at.z < 2.9                       ? 12 - int(4 * at.z) + 13 * (at.x < 2.4)
                                                                 : 0);
  }
  std::string names;
  for (int r = 0; r < 26; ++r)
    names += "R:" + std::to_string(r) + '\n';
  m.cell_array.push_back(residue);
  m.named_text.push_back({"residue_names", names});
  const formats::BodyList list = formats::list_bodies(m, "x.vtu", 2);
  REQUIRE(list.residues.size() == 3); // body, outside, cavity
  std::map<std::string, int> triangles[2];
  for (size_t i = 0; i < m.tri.size(); ++i)
    if (const int32_t r = residue.integer[m.tet.size() + i]; r >= 0) {
      const Vec3d d = cell_centroid(m, m.tet.size() + i) - Vec3d{2.5, 2.5, 2.5};
      const bool cavity = std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)}) < 0.6;
      ++triangles[0]["R:" + std::to_string(r)];
      triangles[1]["R:" + std::to_string(r)] += cavity;
    }
  for (const auto& [body, of] : {std::pair{0, 0}, std::pair{2, 1}}) {
    const std::vector<std::string>& named = list.residues[body];
    CHECK(static_cast<int64_t>(named.size()) ==
          std::count_if(triangles[of].begin(), triangles[of].end(), [](const auto& t) { return t.second > 0; }));
    for (size_t k = 1; k < named.size(); ++k)
      CHECK(triangles[of][named[k - 1]] >= triangles[of][named[k]]);
  }
  const auto j = nlohmann::ordered_json::parse(formats::bodies_json(list));
  CHECK(j["bodies"][2]["residues"] == list.residues[2]);
  CHECK(j["units"]["volume"] == "Å³");
  const std::string text = formats::bodies_text(list);
  CHECK(has(text, "residues round it"));
  CHECK(has(text, (list.residues[2][0] + ", " + list.residues[2][1]).c_str()));
  CHECK(has(text, (" and " + std::to_string(list.residues[0].size() - 8) + " more").c_str()));
}

TEST_CASE("regions of other numbers are called by the names that the mesh has for them") {
  TetMesh m = cubes(3, [](Vec3i c) -> int32_t { return c.x == 0 ? 7 : 9; });
  m.named_text.push_back({"region_names", "7 lipid%20head\n"});
  const std::string text = formats::tetstat_text(report(m)),
                    bodies = formats::bodies_text(formats::list_bodies(m, "x", 1));
  CHECK(has(text, "7   lipid head"));
  CHECK(has(bodies, "lipid head 1"));
  CHECK(has(bodies, "region_9 1"));
  CHECK(json_of(report(m))["regions"][0]["name"] == "lipid head");
}

TEST_CASE("figures end below their headings, however long the names are") {
  const auto end_of = [](const std::string& text, const std::string& word) { // column
    const size_t at = text.find(word), line = text.rfind('\n', at) + 1;
    REQUIRE(at != text.npos);
    return formats::columns(text.substr(line, at + word.size() - line));
  };
  for (const std::string name : {"A", "the%20lipids'%20heads%20α%20and%20β"}) {
    TetMesh m = cubes(3, [](Vec3i c) -> int32_t { return c.x == 0 ? 7 : 9; });
    m.named_text.push_back({"region_names", "7 " + name + "\n"});
    const std::string text = formats::tetstat_text(report(m)),
                      bodies = formats::bodies_text(formats::list_bodies(m, "x", 1));
    for (const std::string& table : {text, bodies})
      for (const char* volume : {" 9.00", " 18.00"})
        CHECK(end_of(table, volume) == end_of(table, "volume/Å³"));
    CHECK(end_of(bodies, " 30.00") == end_of(bodies, "area/Å²"));
  }
}

TEST_CASE("bodies and boundaries are listed, the largest first, and sum to the mesh") {
  TetMesh m = cubes(7, [](Vec3i c) -> int32_t {
    const auto within = [&](int low, int high) {
      return std::min({c.x, c.y, c.z}) >= low && std::max({c.x, c.y, c.z}) <= high;
    };
    return within(2, 2) || within(4, 4) ? Region::cavity : within(1, 5) ? Region::molecule : Region::outside;
  });
  CellArray patch{"patch", std::vector<int32_t>(m.tet.size() + m.tri.size(), 0), {}};
  int found = 0;
  for (size_t i = 0; i < m.tri.size() && found < 3; ++i)
    if (m.boundary[i] == Boundary::surface) {
      patch.integer[m.tet.size() + i] = 8;
      ++found;
    }
  m.cell_array.push_back(patch);
  m.named_text.push_back({"patch_names", "8 site\n"});
  const formats::BodyList list = formats::list_bodies(m, "x.vtu", 1);
  REQUIRE(list.body.size() == 4); // body, outside, two cavities
  CHECK(list.body[0].volume == Approx(123));
  CHECK(list.body[0].area == Approx(150 + 12));
  CHECK(list.body[1].region == Region::outside);
  CHECK(list.body[3].region == Region::cavity);
  CHECK(list.body[3].volume == Approx(1));
  REQUIRE(list.boundary.size() == 8); // the surface, six walls, the site
  CHECK(list.boundary[0].triangles == 2 * 162 - 3);
  CHECK(list.boundary[7].name == "site");
  CHECK(list.boundary[7].area == Approx(1.5));
  CHECK(has(formats::bodies_text(list), "1 body, 2 cavities"));
  const TetMesh inside = cubes(3, [](Vec3i) -> int32_t { return Region::molecule; });
  CHECK(has(
      formats::bodies_text(formats::list_bodies(inside, "x.vtu", 1)),
      "1 body; cavities are holes in this mesh of the inside alone: density2tet --region both has them listed\n"));
  TetMesh around = cubes(7, [](Vec3i c) -> int32_t {
    return c == Vec3i{2, 2, 2} || c == Vec3i{4, 4, 4} ? Region::molecule : Region::outside;
  });
  for (size_t t = around.tet.size(); t-- > 0;)
    if (around.region[t] == Region::molecule) {
      around.tet.erase(around.tet.begin() + static_cast<std::ptrdiff_t>(t));
      around.region.erase(around.region.begin() + static_cast<std::ptrdiff_t>(t));
    }
  CHECK(has(formats::bodies_text(formats::list_bodies(around, "x.vtu", 1)),
            "x.vtu: the outside alone, with 2 holes for the molecule; closed cavities are not in it: "));
  const auto j = nlohmann::ordered_json::parse(formats::bodies_json(list));
  CHECK(j["bodies"].size() == 4);
  CHECK(j["boundaries"][7]["label"] == 8);
}

TEST_CASE("amounts have two decimals, and small ones two digits that count") {
  using formats::amount;
  CHECK(amount(1234567.891) == "1,234,567.89");
  CHECK(amount(0.1) == "0.10");
  CHECK(amount(0.0994) == "0.099");
  CHECK(amount(-0.0432) == "-0.043");
  CHECK(amount(0.00123) == "0.0012");
  CHECK(amount(0) == "0.00");
  CHECK(amount(NAN) == "-");
}
