// mesh_readers_test.cpp — meshes of other programs in every format: regions, labels, names, rules, damage.
#include "base/error.hpp"
#include "formats/gmsh/gmsh.hpp"
#include "formats/medit/medit.hpp"
#include "formats/mesh/read_mesh.hpp"
#include "formats/vtu/names.hpp"
#include "mesh/validity.hpp"
#include "unit/mesh/meshes.hpp"
#include "unit/refusal.hpp"
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <set>
#include <sstream>

using namespace molmesh;
using formats::MeshNotes;
using formats::MeshReading;
namespace fs = std::filesystem;

namespace {

std::vector<fs::path> samples(const std::string& name) {
  std::vector<fs::path> files;
  for (const char* format : {"gmsh", "medit", "vtk"})
    for (const auto& entry :
         fs::directory_iterator(fs::path(MOLMESH_SOURCE_DIR) / "formats" / format / "samples" / name))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string content(const fs::path& p) {
  std::ifstream in(p, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

MeshReading keeping(const std::string& region_array = "", bool merge = false, double scale = 1) {
  MeshReading as;
  as.arrays = formats::CellArrays::keep;
  as.region_array = region_array;
  as.merge_points = merge;
  as.scale = scale;
  return as;
}

TetMesh read(const std::string& text, MeshNotes& notes, const MeshReading& as = keeping()) {
  std::istringstream in(text);
  return formats::read_mesh(in, "x", as, notes);
}
TetMesh read(const std::string& text, const MeshReading& as = keeping()) {
  MeshNotes notes;
  return read(text, notes, as);
}

std::string refusal(const std::string& text, const MeshReading& as = keeping()) {
  return test::refusal(Status::bad_input, [&] { read(text, as); });
}

std::string as_gmsh(const TetMesh& m, formats::GmshVersion v) {
  std::ostringstream out;
  formats::write_gmsh(out, m, v);
  return out.str();
}
std::string as_medit(const TetMesh& m) {
  std::ostringstream out;
  formats::write_medit(out, m);
  return out.str();
}
std::string as_vtu(const TetMesh& m) {
  std::ostringstream out;
  formats::write_vtu(out, m);
  return out.str();
}

/// Arrays of a mesh's cells as .vtu files have them.
TetMesh with_array(TetMesh m, const std::string& name, std::vector<int32_t> value) {
  value.resize(m.tet.size() + m.tri.size(), 0);
  m.cell_array.push_back({name, std::move(value), {}});
  return m;
}

/// A .vtu as other programs write it: without our arrays.
std::string foreign_vtu(const TetMesh& m) {
  std::string text = as_vtu(m);
  for (const char* name : {"\"region\"", "\"boundary\"", "\"isovalue\""})
    for (size_t at = text.find(name); at != std::string::npos; at = text.find(name, at))
      text[at + 1] = 'z';
  return text;
}

/// A box, a molecule in it, a cavity in that; a named boundary; parts, labels.
TetMesh own_mesh() {
  TetMesh m = testing::cubes(5,
                             [](Vec3i p) {
                               const bool inner = p.x > 0 && p.x < 4 && p.y > 0 && p.y < 4 && p.z > 0 && p.z < 4;
                               return p == Vec3i{2, 2, 2} ? 3 : inner ? 1 : 2;
                             },
                             1.0 / 3, {-1e-7, 100, 0.1});
  CellArray patch{"patch", std::vector<int32_t>(m.tet.size(), 0), {}}, residue{"residue", {}, {}},
      share{"share", {}, {}};
  for (size_t t = 0; t < m.tri.size(); ++t)
    patch.integer.push_back(m.boundary[t] == 1 && t % 2 ? 8 : m.boundary[t]);
  for (size_t c = 0; c < m.tet.size() + m.tri.size(); ++c) {
    residue.integer.push_back(static_cast<int32_t>(c % 7) - 1);
    share.real.push_back(static_cast<double>(c) / 7);
  }
  m.cell_array = {patch, residue, share};
  m.named_text = {{"patch_names", "8 active_site\n"}};
  m.part.assign(m.tet.size(), 0);
  for (size_t t = 0; t < m.tet.size(); t += 3)
    m.part[t] = 2;
  return m;
}

/// Triangles with their labels, in any order.
std::multiset<std::array<int32_t, 5>> labelled(const TetMesh& m) {
  std::multiset<std::array<int32_t, 5>> all;
  const std::vector<int32_t> patch = formats::patches(m);
  for (size_t t = 0; t < m.tri.size(); ++t) {
    Tri c = m.tri[t];
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
    all.insert({c[0], c[1], c[2], m.boundary[t], patch[t]});
  }
  return all;
}

const CellArray* find(const TetMesh& m, const std::string& name) {
  for (const CellArray& a : m.cell_array)
    if (a.name == name)
      return &a;
  return nullptr;
}

} // namespace

TEST_CASE("two boxes of Gmsh are the same mesh through every format, regions and names intact") {
  for (const fs::path& p : samples("passed")) {
    INFO(p);
    MeshNotes notes;
    const TetMesh m = read(content(p), notes);
    CHECK(check_validity(m, 1).valid());
    CHECK(m.point.size() == 23);
    const std::set<int32_t> regions(m.region.begin(), m.region.end());
    const bool msh = p.extension() == ".msh";
    CHECK(regions ==
          (p.extension() == ".mesh" ? std::set<int32_t>{1, 2} : std::set<int32_t>{7, 12})); // entities there
    for (const int32_t r : regions)
      CHECK(testing::volume(m, r) == Approx(1));
    CHECK(notes.region_array == (msh ? "gmsh:physical" : p.extension() == ".mesh" ? "medit:ref" : "CellEntityIds"));
    CHECK(notes.dropped_triangles == 0);
    int64_t between = 0;
    const std::vector<int32_t> patch = formats::patches(m);
    for (size_t t = 0; t < m.tri.size(); ++t) {
      const bool on = std::all_of(m.tri[t].begin(), m.tri[t].end(), [&](int32_t v) { return m.point[v].z == 1; });
      between += on;
      if (msh)
        CHECK((patch[t] == 3) == on);
    }
    CHECK(between == 4);
    if (msh) {
      CHECK(formats::names_of(m, "region_names") ==
            std::map<int32_t, std::string>{{7, "steel"}, {12, "warm water"}});
      CHECK(formats::names_of(m, "patch_names").at(4) == "inlet");
      CHECK(std::count(patch.begin(), patch.end(), 4) == 4);
      // And back to Gmsh with the same numbers and names: none is shared.
      const TetMesh back = read(as_gmsh(m, formats::GmshVersion::v4_1));
      CHECK(back.region == m.region);
      CHECK(formats::names_of(back, "region_names") == formats::names_of(m, "region_names"));
      CHECK(formats::patches(back) == patch);
    }
    const TetMesh dropped = read(content(p), MeshReading{});
    CHECK(dropped.cell_array.empty());
    CHECK(dropped.region == m.region);
  }
}

TEST_CASE("what is written for other programs reads back whole: boundaries, names, labels, parts") {
  const TetMesh m = own_mesh();
  for (const auto v : {formats::GmshVersion::v4_1, formats::GmshVersion::v4_1_binary, formats::GmshVersion::v2_2}) {
    const TetMesh back = read(as_gmsh(m, v));
    CHECK(back.point == m.point);
    std::multiset<std::pair<Tet, int32_t>> expected, found; // by region in the file
    for (size_t t = 0; t < m.tet.size(); ++t) {
      expected.insert({m.tet[t], m.region[t]});
      found.insert({back.tet[t], back.region[t]});
    }
    CHECK(found == expected);
    CHECK(labelled(back) == labelled(m));
    CHECK(formats::names_of(back, "patch_names") == formats::names_of(m, "patch_names"));
    if (v == formats::GmshVersion::v2_2)
      continue;
    CHECK(std::count(back.part.begin(), back.part.end(), 2) == std::count(m.part.begin(), m.part.end(), 2));
    REQUIRE(find(back, "residue"));
    std::map<Tet, std::pair<int32_t, double>> value;
    for (size_t t = 0; t < m.tet.size(); ++t)
      value[m.tet[t]] = {m.cell_array[1].integer[t], m.cell_array[2].real[t]};
    for (size_t t = 0; t < m.tet.size(); ++t)
      CHECK(value[back.tet[t]] == std::pair{find(back, "residue")->integer[t], find(back, "share")->real[t]});
  }
  const TetMesh back = read(as_medit(m));
  CHECK(back.tet == m.tet);
  CHECK(back.region == m.region);
  CHECK(labelled(back) == labelled(m));
  CHECK(formats::names_of(back, "patch_names") == formats::names_of(m, "patch_names"));
}

TEST_CASE(
    "numbers in exports are distinct over all dimensions, and numbers of others stay where they are so already") {
  TetMesh m = own_mesh();
  const formats::ExportLabels e = formats::export_labels(m);
  CHECK(e.step == 10);
  CHECK(e.patch_name.at(11) == "surface");
  CHECK(e.patch_name.at(17) == "box_z1");
  CHECK(e.patch_name.at(18) == "active_site");
  CHECK(e.region_name.at(3) == "cavity");
  for (int32_t& r : m.region)
    r += 25;
  CHECK(formats::export_labels(m).step == 100);
  m.cell_array.clear();
  m.named_text.clear();
  m.region.assign(m.tet.size(), 500);
  m.boundary.assign(m.tri.size(), 501);
  CHECK(formats::export_labels(m).step == 0);
  m.boundary[0] = 500;
  CHECK(formats::export_labels(m).step == 1000);
  m.boundary[1] = std::numeric_limits<int32_t>::max();
  CHECK(test::refusal(Status::bad_input, [&] { formats::export_labels(m); }) != "");
}

TEST_CASE("volumes of .msh 4.1 name the surfaces that bound them, with their sides") {
  const std::string text = as_gmsh(own_mesh(), formats::GmshVersion::v4_1);
  std::istringstream in(text.substr(text.find("$Entities")));
  std::string line;
  for (int i = 0; i < 2 + 8; ++i)
    std::getline(in, line);
  std::vector<std::string> ends;
  for (int i = 0; i < 3; ++i) {
    std::getline(in, line);
    std::istringstream words(line);
    std::vector<std::string> w(std::istream_iterator<std::string>(words), {});
    REQUIRE(w.size() > 10);
    std::string bounds;
    for (size_t k = 9; k < w.size(); ++k)
      bounds += w[k] + " ";
    ends.push_back(w[0] + ": " + bounds);
  }
  CHECK(ends == std::vector<std::string>{"1: 2 11 18 ", "2: 8 -11 12 13 14 15 16 17 -18 ", "3: 2 -11 -18 "});
}

TEST_CASE("regions are found in other arrays by usual names or by the name that is asked for") {
  const TetMesh box = testing::cubes(2, [](Vec3i p) { return p.x < 1 ? 1 : 2; });
  TetMesh plain = box;
  const std::vector<int32_t> region = plain.region;
  std::vector<int32_t> values = region;
  for (int32_t& v : values)
    v = v == 1 ? 0 : -4;
  plain = with_array(plain, "MATERIALIDS", values);
  MeshNotes notes;
  TetMesh m = read(foreign_vtu(plain), notes);
  CHECK(notes.region_array == "MATERIALIDS");
  CHECK(notes.renumbered == std::map<int32_t, int32_t>{{-4, 1}, {0, 2}});
  CHECK(find(m, "MATERIALIDS")->integer[0] == 0);
  CHECK(m.region[0] == 2);
  CHECK(testing::volume(m, 1) == Approx(4));
  CHECK(check_validity(m, 1).valid());

  plain = with_array(box, "colour", region); // no usual name: one region, and a warning that names it
  m = read(foreign_vtu(plain), notes);
  CHECK(notes.region_array.empty());
  CHECK(std::set<int32_t>(m.region.begin(), m.region.end()) == std::set<int32_t>{1});
  CHECK(notes.several == std::vector<std::string>{"zegion", "colour"});
  const std::vector<std::string> lines = described(notes);
  CHECK(std::any_of(lines.begin(), lines.end(), [](const std::string& l) {
    return l == "one region for all, though cells have several values of 'zegion', 'colour': --region-array NAME "
                "makes regions of one";
  }));
  m = read(foreign_vtu(plain), notes, keeping("colour"));
  CHECK(m.region == region);
  CHECK(notes.region_array == "colour");
  CHECK(refusal(foreign_vtu(plain), keeping("color")) ==
        "x: no cell array 'color', expected one of 'zegion', 'zoundary', 'colour'[region-array]");
  std::vector<double> large(box.tet.size() + box.tri.size(), 1);
  large[0] = 4294967296.; // no region, but said all the same
  TetMesh beyond = box;
  beyond.cell_array.push_back({"MaterialIds", {}, large});
  m = read(foreign_vtu(beyond), notes);
  CHECK(notes.region_array.empty());
  CHECK(notes.several == std::vector<std::string>{"zegion", "MaterialIds"});
  CHECK(refusal(foreign_vtu(beyond), keeping("MaterialIds")).find("holds no integers of 32 bits, expected") !=
        std::string::npos);
  m = read(as_vtu(with_array(box, "one", std::vector<int32_t>(box.tet.size(), 5))), keeping("one"));
  CHECK(std::set<int32_t>(m.region.begin(), m.region.end()) == std::set<int32_t>{5});
  CHECK(check_validity(m, 1).valid()); // the triangles between the regions of before are gone
}

TEST_CASE("points of pieces that touch are counted, and merged when asked") {
  // Two halves with points of their own, as a program that joins pieces writes them.
  const TetMesh whole = testing::cubes(2, [](Vec3i p) { return p.x < 1 ? 1 : 2; });
  TetMesh pieces = testing::extract(whole, [](int32_t r) { return r == 1; });
  const TetMesh other = testing::extract(whole, [](int32_t r) { return r == 2; });
  const auto first = static_cast<int32_t>(pieces.point.size());
  pieces.point.insert(pieces.point.end(), other.point.begin(), other.point.end());
  for (const auto& t : other.tet)
    pieces.tet.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
  pieces.region.insert(pieces.region.end(), other.region.begin(), other.region.end());
  for (const auto& t : other.tri)
    pieces.tri.push_back({t[0] + first, t[1] + first, t[2] + first});
  pieces.boundary.insert(pieces.boundary.end(), other.boundary.begin(), other.boundary.end());
  MeshNotes notes;
  CHECK(read(as_vtu(pieces), notes).point.size() == 36);
  CHECK(notes.duplicate_points == 9);
  CHECK_FALSE(described(notes).empty());
  const TetMesh m = read(as_vtu(pieces), notes, keeping("", true));
  CHECK(m.point.size() == 27);
  CHECK(check_validity(m, 1).valid());
  CHECK(m.tri.size() == whole.tri.size());
  for (const int32_t label : {1, 2, 3, 4, 5, 6, 7})
    CHECK(std::count(m.boundary.begin(), m.boundary.end(), label) ==
          std::count(whole.boundary.begin(), whole.boundary.end(), label));
}

TEST_CASE("scale makes Å, and the other order of corners is turned round with a note") {
  TetMesh m = testing::cubes(1, testing::all_molecule);
  m.decay = 4;
  const TetMesh scaled = read(as_vtu(m), keeping("", false, 2));
  CHECK(testing::volume(scaled, 1) == Approx(8));
  CHECK(scaled.decay == 1);
  for (Tet& t : m.tet)
    std::swap(t[0], t[1]);
  MeshNotes notes;
  const TetMesh turned = read(as_medit(m), notes);
  CHECK(notes.turned);
  CHECK(testing::volume(turned, 1) == Approx(1));
  CHECK_FALSE(described(notes).empty());
}

TEST_CASE("labels of the file's triangles and our own do not share numbers") {
  TetMesh m = testing::cubes(1, testing::all_molecule);
  m.boundary.assign(m.tri.size(), 1);
  std::string text = as_medit(m);
  const size_t head = text.find("# triangles"), vertices = text.find("Vertices"),
               tris = text.find("Triangles\n12\n");
  text = text.substr(0, head) + text.substr(vertices, tris - vertices) + "Triangles\n1\n1 2 4 1\nEnd\n";
  const Tri one{0, 1, 3};
  const TetMesh back = read(text);
  const std::vector<int32_t> patch = formats::patches(back);
  CHECK(std::count(patch.begin(), patch.end(), 1) <= 1);
  for (size_t t = 0; t < back.tri.size(); ++t) {
    Tri sorted = back.tri[t];
    std::sort(sorted.begin(), sorted.end());
    CHECK((patch[t] == 1) == (sorted == one));
  }
}

TEST_CASE("mesh readers: every broken rule is refused with its number and line") {
  CHECK(samples("failed").size() >= 20);
  for (const fs::path& p : samples("failed")) {
    INFO(p);
    const std::string name = p.filename().string(), rule = name.substr(0, name.find('-'));
    const std::string line = refusal(content(p));
    INFO(line);
    CHECK(line.rfind("x:", 0) == 0);
    CHECK(line.find(": " + rule + ": ") != std::string::npos);
  }
}

TEST_CASE("mesh readers: what is no mesh is refused with the formats that are read") {
  for (const std::string& text : {std::string("hello\n"), std::string("\x8f\x03<\x11\n<"), std::string(100, '\0')})
    CHECK(refusal(text) == "x:1: found no mesh of a format that is known, expected .vtu, .vtk, .msh or .mesh");
  for (const char* text : {"<html>", "\xEF\xBB\xBF\n <html>"}) // XML, but none of VTK
    CHECK(refusal(text).find("R1") != std::string::npos);
}

TEST_CASE("mesh readers: cut and damaged files are refused or read, never more") {
  std::mt19937 random(7);
  int refused = 0;
  for (const fs::path& p : samples("passed")) {
    const std::string text = content(p);
    for (size_t n = 0; n < text.size(); n += 1 + text.size() / 300) {
      try {
        read(text.substr(0, n));
      } catch (const Error& e) {
        CHECK(e.status == Status::bad_input);
        ++refused;
      }
    }
    for (int i = 0; i < 300; ++i) {
      std::string damaged = text;
      for (int k = 0; k <= i % 4; ++k)
        damaged[random() % damaged.size()] = static_cast<char>(random());
      try {
        const TetMesh m = read(damaged);
        for (const Tet& t : m.tet)
          for (const int32_t v : t)
            CHECK(static_cast<size_t>(v) < m.point.size());
        CHECK(m.region.size() == m.tet.size());
        CHECK(m.boundary.size() == m.tri.size());
        for (const CellArray& a : m.cell_array)
          CHECK(a.integer.size() + a.real.size() == m.tet.size() + m.tri.size());
      } catch (const Error& e) {
        CHECK(e.status == Status::bad_input);
        ++refused;
      }
    }
  }
  CHECK(refused > 1000);
}
