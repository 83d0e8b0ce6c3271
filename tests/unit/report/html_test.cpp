// html_test.cpp — pages: what they hold, what is left out of them, where figures come from.
#include "../mesh/meshes.hpp"
#include "../refusal.hpp"
#include "formats/html/embedded.hpp"
#include "formats/html/facts.hpp"
#include "formats/html/html.hpp"
#include "formats/html/run_reports.hpp"
#include "formats/vtu/names.hpp"
#include "geom/tet_quality.hpp"
#include "mesh/adjacency.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace molmesh;
using namespace molmesh::formats;
using nlohmann::json;

namespace {

TetMesh labelled(int n) {
  TetMesh m = testing::cubes(n, [n](Vec3i c) {
    return c.x > 0 && c.x < n - 1 && c.y > 0 && c.y < n - 1 && c.z > 0 && c.z < n - 1 ? 1 : 2;
  });
  for (size_t i = 0; i < m.point.size(); ++i)
    m.point[i] +=
        Vec3d{0.1 * std::sin(double(7 * i)), 0.1 * std::cos(double(5 * i)), 0.1 * std::sin(double(3 * i))};
  CellArray chain{"chain", {}, {}}, residue{"residue", {}, {}};
  for (size_t t = 0; t < m.tet.size(); ++t) {
    const bool in = m.region[t] == 1;
    chain.integer.push_back(in ? int32_t(t % 2) : -1);
    residue.integer.push_back(in ? int32_t(t % 2 + 2 * (t % 3)) : -1);
  }
  for (size_t i = 0; i < m.tri.size(); ++i) {
    const bool on = m.boundary[i] == Boundary::surface;
    chain.integer.push_back(on ? int32_t(i % 2) : -1);
    residue.integer.push_back(on ? int32_t(i % 2 + 2 * (i % 3)) : -1);
  }
  m.cell_array = {chain, residue};
  m.named_text = {{"chain_names", "A\nB\n"}, {"residue_names", "r0\nr1\nr2\nr3\nr4\nr5\n"}};
  m.source = "</script><b>";
  return m;
}

struct Page {
  std::string text;
  json report;
  std::vector<std::string> left_out;
};
Page page(const std::vector<TetMesh>& meshes, double most, int threads, const ReportedMesh& more = {}) {
  HtmlReport report(int64_t(most), int64_t(meshes.size()));
  for (const TetMesh& m : meshes) {
    const TriangleSides sides = triangle_sides(m, threads);
    ReportedMesh own = more;
    own.name = "a \"mesh\".vtu";
    own.picture = "picture";
    own.colour = "chain";
    report.add(m, sides, find_bodies(m, sides.across), cell_labels(m), own, threads);
  }
  std::ostringstream out;
  report.write(out, "<title>", "test 1");
  Page p{out.str(), {}, report.left_out()};
  const std::string begin = "<script type=\"application/json\" id=\"report\">";
  const size_t from = p.text.find(begin) + begin.size();
  p.report = json::parse(p.text.substr(from, p.text.find("</script>", from) - from));
  return p;
}

} // namespace

TEST_CASE("a page names nothing outside itself, and nothing in its data ends a script") {
  const Page p = page({labelled(6)}, 30e6, 1);
  CHECK(p.text.find("<title>&lt;title></title>") != std::string::npos);
  const std::string data = p.text.substr(0, p.text.find("Unpack"));
  CHECK(data.find("</script><b>") == std::string::npos);
  CHECK(p.report["meshes"][0]["source"] == "</script><b>");
  for (const char* const key : {"<script src", "<link rel=\"stylesheet", "@import", "url(", "fetch("})
    CHECK(p.text.find(key) == std::string::npos);
  CHECK(p.text.find("@DATA@") == std::string::npos);
  CHECK(p.left_out.empty() == HtmlReport::has_3d());
}

TEST_CASE("a page has the same bytes at any number of threads") {
  const std::vector<TetMesh> meshes{labelled(6), labelled(5)};
  const Page one = page(meshes, 30e6, 1);
  CHECK(page(meshes, 30e6, 4).text == one.text);
}

TEST_CASE("a page's figures are those of the mesh") {
  const TetMesh m = labelled(6);
  const json j = page({m}, 30e6, 1).report["meshes"][0];
  CHECK(j["tets"] == m.tet.size());
  CHECK(j["bodies"].size() == 2);
  double area = 0;
  for (size_t i = 0; i < m.tri.size(); ++i)
    if (m.boundary[i] == 1)
      area += tri_area(m.point[m.tri[i][0]], m.point[m.tri[i][1]], m.point[m.tri[i][2]]);
  CHECK(j["bodies"][0]["volume"].get<double>() == Approx(testing::volume(m, 1)));
  CHECK(j["boundaries"][0]["name"] == "surface");
  CHECK(j["boundaries"][0]["area"].get<double>() == Approx(area));
  CHECK(j["bodies"][0]["residue_count"] == 6);
  int64_t dihedrals = 0;
  for (const json& bin : j["quality"]["dihedral"]["bins"])
    dihedrals += bin.get<int64_t>();
  CHECK(dihedrals == int64_t(6 * m.tet.size()));
  CHECK(j["quality"]["smallest"][0].get<double>() == Approx(j["quality"]["dihedral"]["min"].get<double>()));
  CHECK(j["quality"]["largest"][1].get<double>() == Approx(j["quality"]["dihedral"]["max"].get<double>()));
}

TEST_CASE("domains are the molecule, and what lies between two of them is no part of its surface") {
  TetMesh m = labelled(6);
  m.cell_array = {};
  m.named_text = {{"region_level", "domain"}, {"region_names", "4 one\n5 other\n"}};
  for (size_t t = 0; t < m.tet.size(); ++t)
    if (m.region[t] == 1)
      m.region[t] = m.point[m.tet[t][0]].x + m.point[m.tet[t][3]].x < 6 ? 4 : 5;
  const json before = page({m}, 30e6, 1).report["meshes"][0];
  const LargeArray<int32_t> across = face_neighbors(m, 1);
  const size_t outer = m.tri.size();
  for (int32_t f = 0; f < std::ssize(across); ++f)
    if (across[f] >= 0 && m.region[f / 4] == 4 && m.region[across[f] / 4] == 5) {
      m.tri.push_back(face_points(m, f));
      m.boundary.push_back(8);
    }
  REQUIRE(m.tri.size() > outer);
  const json j = page({m}, 30e6, 1).report["meshes"][0];
  double volume = 0, area = 0;
  for (const json& b : j["bodies"])
    volume += b["molecular"].get<bool>() ? b["volume"].get<double>() : 0;
  for (size_t i = 0; i < outer; ++i)
    if (m.boundary[i] == 1)
      area += tri_area(m.point[m.tri[i][0]], m.point[m.tri[i][1]], m.point[m.tri[i][2]]);
  CHECK(j["surface"].get<double>() == Approx(area));
  CHECK(before["surface"].get<double>() == Approx(area));
  CHECK(volume > 40);
  CHECK(volume < 100);
}

TEST_CASE("the worst elements are those of the optimizer's quality, with the residues there") {
  const TetMesh m = labelled(6);
  std::vector<std::pair<float, int64_t>> order;
  for (size_t t = 0; t < m.tet.size(); ++t)
    order.push_back(
        {tet_quality(m.point[m.tet[t][0]], m.point[m.tet[t][1]], m.point[m.tet[t][2]], m.point[m.tet[t][3]]),
         int64_t(t)});
  std::sort(order.begin(), order.end());
  const std::vector<int64_t> worst = worst_by_quality(m, 10, 3);
  REQUIRE(worst.size() == 10);
  for (size_t i = 0; i < 10; ++i)
    CHECK(worst[i] == order[i].second);
  const json j = page({m}, 30e6, 1).report["meshes"][0];
  for (size_t i = 0; i < 10; ++i) {
    CHECK(j["worst"][i]["tet"] == worst[i]);
    const std::string residue = j["worst"][i]["residue"];
    if (const int64_t t = worst[i]; m.region[t] == 1)
      CHECK(residue == (t % 2 ? "//B/(r" : "//A/(r") + std::to_string(t % 2 + 2 * (t % 3)) + ')');
    else
      CHECK(residue.size() == 8); // that of a triangle nearby
  }
}

TEST_CASE("what a page may not hold is left out, and it says so", "[slow]") {
  if (!HtmlReport::has_3d())
    return; // stills alone, whatever it may hold
  const TetMesh m = labelled(20);
  const auto state = [&](double most) { // 0: a picture alone, 1: parts, 2: all of it
    const Page p = page({m}, most, 2);
    const json& mesh = p.report["meshes"][0];
    if (mesh.count("code") == 0) {
      REQUIRE(p.left_out.size() == 1);
      CHECK(p.left_out[0].find("a picture of this mesh alone") != std::string::npos);
      return 0;
    }
    CHECK(mesh["code"]["triangles"].get<size_t>() == m.tri.size());
    for (const json& w : mesh["worst"])
      if (mesh.count("cuts") > 0 || p.left_out.empty())
        CHECK(w["place"].get<int>() >= 0);
    if (p.left_out.empty()) {
      CHECK(mesh["code"]["tets"].get<size_t>() == m.tet.size());
      return 2;
    }
    CHECK(mesh["code"]["tets"].get<size_t>() < m.tet.size());
    CHECK(p.left_out[0].find("Of 48,000 tetrahedra the page holds") != std::string::npos);
    CHECK(mesh["left_out"].get<std::string>() == p.left_out[0].substr(p.left_out[0].find("Of 48")));
    return 1;
  };
  const double library = 0.5 * double(embedded::three_js().size());
  std::string states;
  for (double code = 0; code <= 240e3; code += 12e3)
    if (const char c = char('0' + state(library + code)); states.empty() || states.back() != c)
      states += c;
  CHECK(states == "012");
}

TEST_CASE("labels are numbered by their names, and others by rank") {
  TetMesh m = labelled(4);
  m.cell_array.push_back({"kind", std::vector<int32_t>(m.tet.size() + m.tri.size(), 40), {}});
  m.cell_array.back().integer[3] = 7;
  m.cell_array.back().integer[4] = -5;
  m.part.assign(m.tet.size(), 2);
  const std::vector<CellLabel> labels = cell_labels(m);
  REQUIRE(labels.size() == 5);
  CHECK(labels[0].name == "boundary");
  CHECK(labels[0].names.front() == "surface");
  CHECK(labels[1].name == "part");
  CHECK(find_label(labels, "kind")->names == std::vector<std::string>{"7", "40"});
  CHECK(find_label(labels, "kind")->tet[3] == 0);
  CHECK(find_label(labels, "kind")->tet[4] == -1);
  CHECK(find_label(labels, "kind")->tri[0] == 1);
  CHECK(usual_colour(m, labels) == "chain");
  TetMesh named = m; // by its user
  named.cell_array.push_back({"patch", std::vector<int32_t>(m.tet.size() + m.tri.size(), 0), {}});
  named.cell_array.back().integer[m.tet.size()] = 8;
  named.named_text.push_back({"patch_names", "8 site\n9 none\n"});
  CHECK(user_boundaries(named) == std::map<int32_t, std::string>{{8, "site"}});
  CHECK(usual_colour(named, cell_labels(named)) == "boundary");
  const TriangleSides sides = triangle_sides(m, 1);
  const MeshBodies bodies = find_bodies(m, sides.across);
  CHECK(test::refusal(Status::usage, [&] { colouring_by("helix", m, sides, bodies, labels); }) ==
        "found the colour 'helix', expected one of plain, region, body, boundary, part, chain, residue, "
        "kind[colour]");
  CHECK(colouring_by("chain", m, sides, bodies, labels).legend.size() == 2);
  CHECK(colouring_by("region", m, sides, bodies, labels).legend.size() == 2);
}

TEST_CASE("domains have their names, and the surface is theirs") {
  TetMesh m = labelled(4);
  m.cell_array.clear();
  for (size_t t = 0; t < m.tet.size(); ++t)
    if (m.region[t] == Region::molecule)
      m.region[t] = cell_centroid(m, t).x < 2 ? 4 : 5;
  add_region_names(m, "domain", {{4, "actin"}, {5, "tropo myosin"}}, {{8, "actin-tropo myosin"}});
  const TriangleSides sides = triangle_sides(m, 1);
  const MeshBodies bodies = find_bodies(m, sides.across);
  const std::vector<CellLabel> labels = cell_labels(m);
  CHECK(usual_colour(m, labels) == "region");
  const picture::Colouring c = colouring_by("region", m, sides, bodies, labels);
  std::vector<std::string> names;
  for (const auto& row : c.legend)
    names.push_back(row.first);
  CHECK(names == std::vector<std::string>{"outside", "actin", "tropo myosin"});
  for (size_t i = 0; i < m.tri.size(); ++i)
    if (m.boundary[i] == Boundary::surface)
      CHECK(c.triangle[i].r + 256 * c.triangle[i].g != c.legend[0].second.r + 256 * c.legend[0].second.g);
  ReportedMesh more;
  const json page_of = page({m}, 1e9, 1, more).report;
  const json& regions = page_of["meshes"][0]["regions"];
  REQUIRE(regions.size() == 3);
  CHECK(regions[0] == json{{"region", 4}, {"name", "actin"}});
  CHECK(regions[2]["name"] == "outside");
}

TEST_CASE("the run reports of a mesh are those of the chain that ends in it") {
  const auto report = [](const std::string& tool, const std::string& in, const std::string& out,
                         const json& options) {
    return read_run_report(
        json{{"tool", tool}, {"version", "1"}, {"input", in}, {"output", out}, {"options", options}}.dump(),
        "r.json");
  };
  const std::vector<RunReport> runs{report("tetsmooth", "x/a.tet.vtu", "y/a.vtu", {{"density", "z/a.vdb"}}),
                                    report("hier2density", "a.hier", "a.vdb", json::object()),
                                    report("density2tet", "a.vdb", "a.tet.vtu", json::object()),
                                    report("tetsmooth", "b.tet.vtu", "b.vtu", json::object())};
  std::string order;
  for (const std::string& r : runs_of(runs, "elsewhere/a.vtu", false))
    order += json::parse(r)["tool"].get<std::string>() + ' ';
  CHECK((order == "hier2density density2tet tetsmooth " || order == "density2tet hier2density tetsmooth "));
  CHECK(runs_of(runs, "c.vtu", false).empty());
  CHECK(runs_of(runs, "c.vtu", true).size() == 4);
  CHECK(test::refusal(Status::bad_input, [] { read_run_report("{\"tool\":1}", "r.json"); }) ==
        "r.json: found no run report, expected a JSON object with tool, version, input and output");
}
