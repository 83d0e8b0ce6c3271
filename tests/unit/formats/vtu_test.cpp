// vtu_test.cpp — the rules of VTUv1.md, the exact round trip, foreign encodings.
#include "base/error.hpp"
#include "formats/vtu/vtu.hpp"
#include "mesh/adjacency.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <set>
#include <sstream>

using namespace molmesh;
namespace fs = std::filesystem;

namespace {

fs::path folder(const char* name) {
  return fs::path(MOLMESH_SOURCE_DIR) / "formats/vtu/samples" / name;
}

std::vector<fs::path> samples(const char* name) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder(name)))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string content(const fs::path& p) {
  std::ifstream in(p, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TetMesh read_text(const std::string& text, formats::MeshNotes* notes = nullptr) {
  std::istringstream in(text);
  return formats::read_vtu(in, "x.vtu", notes);
}

std::string written(const TetMesh& m) {
  std::ostringstream out;
  formats::write_vtu(out, m);
  return out.str();
}

/// The message of a file that must be refused.
std::string refusal(const std::string& text) {
  return test::refusal(Status::bad_input, [&] { read_text(text); });
}

/// Two tetrahedra on one face, regions 1 and 2.
TetMesh two_tets() {
  TetMesh m;
  m.point = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  m.tet = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  m.region = {1, 2};
  rebuild_triangles(m);
  m.isovalue = 1.25;
  m.source = "two tetrahedra";
  m.creator = "VTK 9.1";
  return m;
}

TetMesh read_arrays(const std::string& text) {
  std::istringstream in(text);
  return formats::read_vtu(in, "x.vtu", nullptr, formats::CellArrays::keep);
}

void check_same(const TetMesh& a, const TetMesh& b) {
  CHECK(a.point == b.point);
  CHECK(a.tet == b.tet);
  CHECK(a.region == b.region);
  CHECK(a.part == b.part);
  CHECK(a.tri == b.tri);
  CHECK(a.boundary == b.boundary);
  CHECK(a.isovalue == b.isovalue);
  CHECK(a.decay == b.decay);
  CHECK(a.atoms == b.atoms);
  CHECK(a.source == b.source);
  CHECK(a.creator == b.creator);
  REQUIRE(a.sphere.has_value() == b.sphere.has_value());
  if (a.sphere) {
    CHECK(a.sphere->center == b.sphere->center);
    CHECK(a.sphere->radius == b.sphere->radius);
  }
}

/// Triangles as sets of rotations.
std::vector<Tri> rotated(std::vector<Tri> t) {
  for (Tri& x : t)
    std::rotate(x.begin(), std::min_element(x.begin(), x.end()), x.end());
  std::sort(t.begin(), t.end());
  return t;
}

} // namespace

TEST_CASE("what is written is read back exactly, and written again as the same bytes") {
  TetMesh m = two_tets();
  m.point[4] = {0x1.fffffffffffffp+3, -0.0, 1e-17};
  m.isovalue = 0.1;
  m.decay = GENERATE(0., 0.7);
  m.atoms = GENERATE(int64_t{0}, int64_t{14'000'000'000'001});
  if (GENERATE(false, true))
    m.sphere = Sphere{{0.1, -2e-300, 3}, 0x1.fffffffffffffp+3};
  m.source = "caf\xc3\xa9 & <1tii>.pdb </AppendedData> _";
  for (bool parts : {false, true}) {
    m.part = parts ? std::vector<int32_t>{7, 0} : std::vector<int32_t>{};
    formats::MeshNotes notes;
    const std::string text = written(m);
    const TetMesh back = read_text(text, &notes);
    check_same(back, m);
    CHECK(std::signbit(back.point[4].y));
    CHECK(written(back) == text);
    CHECK_FALSE(notes.region_missing);
    CHECK_FALSE(notes.boundary_missing);
  }
}

TEST_CASE("golden bytes of version 1") {
  const TetMesh m = [] {
    TetMesh golden = two_tets();
    golden.part = {0, 1};
    golden.creator = "molmesh 0.1.0";
    return golden;
  }();
  CHECK(written(m) == content(folder("passed") / "molmesh-v1.vtu"));
}

TEST_CASE("foreign encodings of the same mesh read the same") {
  const TetMesh expected = two_tets();
  for (const fs::path& file : samples("passed")) {
    INFO(file.filename());
    formats::MeshNotes notes;
    const TetMesh m = read_text(content(file), &notes);
    const bool extra = file.stem().string().find("extra") != std::string::npos;
    const bool no_labels = file.stem().string().find("no-labels") != std::string::npos;
    CHECK(m.point == expected.point);
    CHECK(m.tet == expected.tet);
    CHECK(notes.dropped_cells == (extra || no_labels ? 3 : 0));
    CHECK(notes.region_missing == no_labels);
    CHECK(notes.boundary_missing == no_labels);
    if (no_labels) {
      CHECK(m.region == std::vector<int32_t>{1, 1});
      CHECK(m.tri.size() == 6);
      CHECK(m.boundary == std::vector<int32_t>(6, 1));
    } else {
      CHECK(m.region == expected.region);
      CHECK(rotated(m.tri) == rotated(expected.tri));
      CHECK(m.boundary == expected.boundary);
    }
  }
}

TEST_CASE("CGAL's .vtu, whose appended data have no end tag, reads as its text does") {
  const std::string with = content(fs::path(MOLMESH_SOURCE_DIR) / "tests/data/cgal/cgal-mesh3.vtu"),
                    without = content(fs::path(MOLMESH_SOURCE_DIR) / "tests/data/cgal/cgal-mesh3-binary.vtu");
  REQUIRE(without.find("</AppendedData") == std::string::npos);
  const TetMesh a = read_text(with), b = read_text(without);
  CHECK(a.tet == b.tet);
  CHECK(a.region == b.region);
  REQUIRE(a.point.size() == b.point.size());
  for (size_t p = 0; p < a.point.size(); ++p)
    CHECK(norm(a.point[p] - b.point[p]) < 1e-5); // six digits
  CHECK(refusal(without.substr(0, without.size() - 20)).find("R4") != std::string::npos);
}

TEST_CASE("each failed sample breaks the rule in its name") {
  for (const fs::path& file : samples("failed")) {
    INFO(file.filename());
    const std::string name = file.stem().string(), message = refusal(content(file));
    INFO(message);
    const std::string rule = name.substr(0, name.find('-'));
    CHECK(message.rfind("x.vtu:", 0) == 0);
    CHECK(message.find(": " + rule + ": ") != std::string::npos);
    CHECK(message.find('\n') == std::string::npos);
  }
}

TEST_CASE("lines in messages count from 1") {
  CHECK(refusal(content(folder("failed") / "R5-not-a-number.vtu")).rfind("x.vtu:13: ", 0) == 0);
  CHECK(refusal(content(folder("failed") / "R8-offsets-fall.vtu")).rfind("x.vtu:19: ", 0) == 0);
}

TEST_CASE("a file cut anywhere is refused, and so is one with a byte changed, or it reads as a mesh") {
  std::mt19937_64 random(5);
  for (const fs::path& file : samples("passed")) {
    INFO(file.filename());
    const std::string text = content(file);
    const size_t whole = text.rfind("</VTKFile>") + 10;
    for (size_t n = 0; n < whole; n += 1 + random() % 7) {
      INFO(n);
      CHECK_FALSE(refusal(text.substr(0, n)).empty());
    }
    for (int n = 0; n < 500; ++n) {
      std::string changed = text;
      for (int k = 0; k < 1 + n % 3; ++k)
        changed[random() % changed.size()] = static_cast<char>(random());
      try {
        const TetMesh m = read_text(changed);
        for (const Tet& t : m.tet)
          for (int32_t v : t)
            REQUIRE((v >= 0 && static_cast<size_t>(v) < m.point.size()));
      } catch (const Error& e) {
        REQUIRE(e.status == Status::bad_input);
      }
    }
  }
}

TEST_CASE("pieces that share one large block are refused before they fill the memory") {
  const std::string bytes(size_t{1} << 20, '\0');
  std::string text = "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" header_type=\"UInt64\"><UnstructuredGrid>";
  const auto array = [](const char* type, const char* name, const char* offset) {
    return std::string("<DataArray type=\"") + type + "\" Name=\"" + name +
           "\" NumberOfComponents=\"3\" format=\"appended\" offset=\"" + offset + "\"/>";
  };
  const std::string points = std::to_string(bytes.size() / 3), end = std::to_string(8 + bytes.size() / 3 * 3);
  for (int i = 0; i < 2000; ++i)
    text += "<Piece NumberOfPoints=\"" + points + "\" NumberOfCells=\"0\"><Points>" +
            array("UInt8", "Points", "0") + "</Points><Cells>" + array("UInt8", "connectivity", end.c_str()) +
            array("UInt8", "offsets", end.c_str()) + array("UInt8", "types", end.c_str()) + "</Cells></Piece>";
  text += "</UnstructuredGrid><AppendedData encoding=\"raw\">_";
  const uint64_t size = bytes.size() / 3 * 3, none = 0;
  text.append(reinterpret_cast<const char*>(&size), 8);
  text += bytes.substr(0, size);
  text.append(reinterpret_cast<const char*>(&none), 8);
  text += "\n</AppendedData></VTKFile>";
  CHECK(refusal(text).find("R5: with array 'Points' the file holds more than its size") != std::string::npos);
}

TEST_CASE("a random mesh of some size survives the round trip") {
  std::mt19937_64 random(6);
  TetMesh m;
  for (int i = 0; i < 30'000; ++i)
    m.point.push_back({std::ldexp(double(random()), -60), double(random() % 100) / 7, -double(i)});
  for (int i = 0; i < 50'000; ++i) {
    m.tet.push_back({int32_t(random() % 30'000), int32_t(random() % 30'000), int32_t(i % 30'000), 0});
    m.region.push_back(int32_t(random() % 3 + 1));
    m.part.push_back(int32_t(random() % 64));
  }
  for (int i = 0; i < 10'001; ++i) {
    m.tri.push_back({int32_t(i), int32_t(random() % 30'000), 1});
    m.boundary.push_back(int32_t(random() % 7 + 1));
  }
  check_same(read_text(written(m)), m);
}

TEST_CASE(".vtu: further arrays and texts read back exactly, or are dropped") {
  TetMesh m = two_tets();
  const size_t cells = m.tet.size() + m.tri.size();
  CellArray integer{"residue", {}, {}}, real{"a \"share\"", {}, {}};
  for (size_t c = 0; c < cells; ++c) {
    integer.integer.push_back(static_cast<int32_t>(c) * 1000003 - 1);
    real.real.push_back(1.0 / static_cast<double>(c + 3));
  }
  m.cell_array = {integer, real};
  m.named_text = {{"residue_names", "GLY:1\nALA:2\n"}, {"empty", ""}};
  const std::string text = written(m);
  const TetMesh back = read_arrays(text);
  check_same(back, m);
  REQUIRE(back.cell_array.size() == 2);
  CHECK(back.cell_array[0].name == "residue");
  CHECK(back.cell_array[0].integer == integer.integer);
  CHECK(back.cell_array[0].real.empty());
  CHECK(back.cell_array[1].real == real.real);
  REQUIRE(back.named_text.size() == 2);
  CHECK(back.named_text[0].text == m.named_text[0].text);
  CHECK(back.named_text[1].text.empty());
  CHECK(written(back) == written(read_arrays(written(back))));
  const TetMesh dropped = read_text(text);
  check_same(dropped, m);
  CHECK(dropped.cell_array.empty());
  CHECK(dropped.named_text.empty());
}

TEST_CASE(".vtu: arrays of foreign files, in the order of our cells") {
  for (const fs::path& p : samples("passed")) { // every encoding; vtk-extra-cells has other cells between
    INFO(p);
    const TetMesh m = read_arrays(content(p)), plain = read_text(content(p));
    check_same(m, plain);
    for (const CellArray& a : m.cell_array)
      CHECK(a.integer.size() + a.real.size() == m.tet.size() + m.tri.size());
  }
  // Triangles before tetrahedra, two pieces, one array not in both, one beyond 32 bits.
  const auto piece = [](int first, const char* type, const std::string& more) {
    return "<Piece NumberOfPoints=\"4\" NumberOfCells=\"2\"><Points><DataArray type=\"Float64\" "
           "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 "
           "1</DataArray></Points><Cells><DataArray "
           "type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 2 1 0 1 2 3</DataArray><DataArray "
           "type=\"Int32\" "
           "Name=\"offsets\" format=\"ascii\">3 7</DataArray><DataArray type=\"UInt8\" Name=\"types\" "
           "format=\"ascii\">5 10</DataArray></Cells><CellData><DataArray type=\"Int32\" Name=\"boundary\" "
           "format=\"ascii\">1 0</DataArray><DataArray type=\"" +
           std::string(type) + "\" Name=\"mine\" format=\"ascii\">" + std::to_string(first) + " " +
           std::to_string(first + 1) + "</DataArray>" + more + "</CellData></Piece>";
  };
  const auto file = [](const std::string& pieces) {
    return "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><UnstructuredGrid>" +
           pieces + "</UnstructuredGrid></VTKFile>\n";
  };
  const std::string once = "<DataArray type=\"Int64\" Name=\"once\" format=\"ascii\">1 99999999999</DataArray>";
  TetMesh m = read_arrays(file(piece(10, "Int64", once) + piece(20, "UInt8", "")));
  REQUIRE(m.cell_array.size() == 1);
  CHECK(m.cell_array[0].integer == std::vector<int32_t>{11, 21, 10, 20});
  m = read_arrays(file(piece(10, "Int64", "") + piece(20, "Float32", "")));
  CHECK(m.cell_array[0].real == std::vector<double>{11, 21, 10, 20});
  m = read_arrays(file(piece(10, "Int64", once))); // too wide for an Int32
  REQUIRE(m.cell_array.size() == 2);
  CHECK(m.cell_array[0].integer == std::vector<int32_t>{11, 10});
  CHECK(m.cell_array[1].real == std::vector<double>{99999999999, 1});
}

TEST_CASE(".vtu: without `boundary` triangles of the file lend the rebuilt ones their values") {
  // Two tetrahedra on a face; triangles on an outer face, turned, on the face between, and on none.
  const auto array = [](const char* type, const char* name, const char* values) {
    return std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" format=\"ascii\">" + values +
           "</DataArray>";
  };
  const std::string text =
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece "
      "NumberOfPoints=\"5\" NumberOfCells=\"5\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
      "format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1</DataArray></Points><Cells>" +
      array("Int32", "connectivity", "0 1 2 3 1 2 3 4 0 1 2 2 3 1 0 1 4") +
      array("Int32", "offsets", "4 8 11 14 17") + array("UInt8", "types", "10 10 5 5 5") + "</Cells><CellData>" +
      array("Int32", "patch", "0 0 11 12 13") + array("Float64", "mine", "1 2 3.5 4.5 5.5") +
      "</CellData></Piece></UnstructuredGrid></VTKFile>\n";
  std::istringstream in(text);
  formats::MeshNotes notes;
  const TetMesh m = formats::read_vtu(in, "x.vtu", &notes, formats::CellArrays::keep);
  CHECK(notes.triangles == 3);
  CHECK(notes.dropped_triangles == 2);
  CHECK(described(notes).size() == 1);
  REQUIRE(m.tri.size() == 6);
  for (size_t t = 0; t < m.tri.size(); ++t) {
    const bool known = std::set<int32_t>(m.tri[t].begin(), m.tri[t].end()) == std::set<int32_t>{0, 1, 2};
    CHECK(m.cell_array[0].integer[2 + t] == (known ? 11 : 1));
    CHECK(m.cell_array[1].real[2 + t] == (known ? 3.5 : 0));
  }
}
