// file_kind_test.cpp — a file given to the wrong program is named, with the program that reads it.
#include "cli/file_kind.hpp"
#include <catch2/catch.hpp>

using molmesh::cli::file_kind;

TEST_CASE("a file's first bytes tell what it is") {
  CHECK(file_kind("hier 1\nlevels\n").ending == ".hier");
  CHECK(file_kind(" BDV\0\0\0\0").ending == ".vdb");
  CHECK(file_kind("<?xml version=\"1.0\"?>\n<VTKFile type=").ending == ".vtu");
  CHECK(file_kind("$MeshFormat\n4.1 0 8\n").ending == ".vtu");
  CHECK(file_kind("# made by hand\nATOM      1  N   GLY A   1").advice == "run pdb2hier first");
  CHECK(file_kind("data_1TII\n#\n").what == "an mmCIF file");
  CHECK(file_kind(std::string(208, '\0') + "MAP " + std::string(20, ' ')).ending == ".map");
}

TEST_CASE("what is nothing known is not named") {
  CHECK(file_kind("").ending.empty());
  CHECK(file_kind("\n\n").ending.empty());
  CHECK(file_kind("an ATOM in a sentence").ending.empty());
}
