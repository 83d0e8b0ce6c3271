// file_kind_test.cpp — a file given to the wrong program is named, with what to do with it.
#include "cli/file_kind.hpp"
#include "tools/mesh_endings.hpp"
#include <catch2/catch.hpp>

using namespace molmesh::cli;
using std::string_view_literals::operator""sv;

TEST_CASE("a file's first bytes tell what it is") {
  const auto kind = [](std::string_view head) { return file_kind(head).kind; };
  CHECK(kind("hier 1\nlevels\n") == Kind::hierarchy);
  CHECK(kind(" BDV\0\0\0\0"sv) == Kind::density);
  CHECK(kind("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\"") == Kind::mesh);
  CHECK(kind("$MeshFormat\n4.1 0 8\n") == Kind::mesh);
  CHECK(kind("# made by hand\nATOM      1  N   GLY A   1") == Kind::structure);
  CHECK(kind("data_1TII\n#\n") == Kind::structure);
  CHECK(kind("{\"data_1TII\": {") == Kind::structure);
  CHECK(kind("Title\n    2\n    1ALA      N    1   0.100   0.200   0.300\n") == Kind::structure);
  CHECK(kind("1.5 2.0 -3.25 1.7\n") == Kind::structure);
  CHECK(kind("1.5 2.0 -3.25 1.7 1 CA_ALA_1\n") == Kind::structure);
  CHECK(kind("8 3 0 0\n1 0.5 0.5 0.5\n") == Kind::unknown); // TetGen's .node
  CHECK(kind(std::string(208, '\0') + "MAP " + std::string(20, ' ')) == Kind::map);
  CHECK(kind("object 1 class gridpositions counts 3 3 3\n") == Kind::map);
  CHECK(kind("join 1\n") == Kind::plan);
  CHECK(kind("{\n \"tool\": \"tetsmooth\", \"phases\": []") == Kind::report);
}

TEST_CASE("what no program reads is named") {
  const auto what = [](std::string_view head, uint64_t size = 0) { return file_kind(head, size).what; };
  CHECK(what("\x89PNG\r\n"sv) == "a picture (PNG)");
  CHECK(what("\xFF\xD8\xFF\xE0"sv) == "a picture (JPEG)");
  CHECK(what("PK\x03\x04"sv) == "a zip archive");
  CHECK(what("T\0\0\0CORD"sv) == "a trajectory (DCD)");
  CHECK(what("\0\0\x07\xCB"sv) == "a trajectory (GROMACS XTC)");
  CHECK(what("\n<!DOCTYPE HTML>\n<html>") == "a web page (HTML)");
  CHECK(what("<?xml version=\"1.0\"?><Xdmf Version=\"3.0\">") == "a mesh in XDMF");
  CHECK(what("<VTKFile type=\"PolyData\"") == "a surface (VTK PolyData)");
  CHECK(what("solid x\n facet normal 0 0 1\n") == "a surface (STL)");
  CHECK(what("# Blender\nmtllib x.mtl\nv 1 1 1\nv 0 0 1\nv 0 1 0\nf 1 2 3\n") == "a surface (OBJ)");
  CHECK(what("ply\nformat ascii 1.0\n") == "a surface (PLY)");
  const std::string stl = std::string(80, 'x') + std::string("\2\0\0\0", 4) + std::string(50, '\0');
  CHECK(what(stl, 184) == "a surface (STL)");
  CHECK(what(stl, 185).empty());
}

TEST_CASE("what is nothing known is not named") {
  for (const char* text : {"", "\n\n", "an ATOM in a sentence", "v good\n"}) {
    INFO(text);
    CHECK(file_kind(text).what.empty());
  }
}

TEST_CASE("the advice leads from what was found to what is wanted") {
  const auto from = [](Kind found, Kind wanted, const char* program = "", bool main = true) {
    return advice({found, "", ""}, wanted, program, main);
  };
  CHECK(from(Kind::structure, Kind::hierarchy) == "run pdb2hier first");
  CHECK(from(Kind::structure, Kind::mesh) == "run pdb2hier, then hier2density, then density2tet first");
  CHECK(from(Kind::density, Kind::hierarchy) == "hier2density makes it from a .hier; give it to density2tet");
  CHECK(from(Kind::density, Kind::hierarchy, "tetstat", false) == "give the .hier that pdb2hier made");
  CHECK(from(Kind::mesh, Kind::density, "tetsmooth", false) == "give the .vdb that hier2density made");
  CHECK(from(Kind::map, Kind::mesh) == "run map2density, then density2tet first");
  CHECK(from(Kind::hierarchy, Kind::mesh, "tetlabel") == "the mesh comes first, then the .hier");
  CHECK(from(Kind::density, Kind::plan, "densityjoin") == "name it with --piece");
  CHECK(advice(file_kind("OFF\n3 1 0\n"), Kind::hierarchy, "", true).find("no atoms") != std::string::npos);
}

TEST_CASE("the ending of a name tells a kind, in letters of any case and packed") {
  CHECK(kind_by_name("a/1tii.pdb") == Kind::structure);
  CHECK(kind_by_name("1TII.CIF.gz") == Kind::structure);
  CHECK(kind_by_name("x.tet.vtu") == Kind::mesh);
  CHECK(kind_by_name("x.hier") == Kind::hierarchy);
  CHECK(kind_by_name("x.vdb") == Kind::density);
  CHECK(kind_by_name("x.mrc") == Kind::map);
  CHECK(kind_by_name("x.html") == Kind::other);
  for (const char* none : {"-", "", "x", ".vtu", "a.vtu/x", "x.", "x.out", "/dev/null", "x.1-of-2.tile", "x.gz"}) {
    INFO(none);
    CHECK(kind_by_name(none) == Kind::unknown);
  }
  for (const auto& [ending, format] : molmesh::mesh_endings) {
    INFO(ending);
    CHECK(kind_by_name(std::string("x") + ending) == Kind::mesh);
  }
}
