// same_source_test.cpp — a density of another structure, isovalue, decay rate or number of atoms is refused, one
// that says nothing is not.
#include "mesh/same_source.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;

TEST_CASE("a density belongs to a mesh where sums, isovalues, decay rates and numbers of atoms that both name are "
          "the same") {
  TetMesh m;
  m.source = "1crn.pdb sha256:69ed";
  m.isovalue = 1;
  FieldInfo field;
  field.source = "1ubq.pdb sha256:1f46";
  const auto refused = [&](bool has_isovalue) {
    return test::refusal(Status::bad_input, [&] { require_same_source(m, has_isovalue, field, "c.vdb"); });
  };
  const auto passes = [&](bool has_isovalue) { require_same_source(m, has_isovalue, field, "c.vdb"); };
  CHECK(refused(true) == "c.vdb: the density of 1ubq.pdb sha256:1f46, expected the mesh's 1crn.pdb sha256:69ed");
  field.source = "other name sha256:69ed";
  passes(true);
  field.isovalue = 0.5;
  CHECK(refused(true) == "c.vdb: the isovalue 0.5, expected the mesh's 1");
  passes(false);
  field.isovalue = 1;
  field.decay = 2;
  passes(true); // the mesh names none
  m.decay = 1;
  CHECK(refused(true) == "c.vdb: the decay rate 2, expected the mesh's 1");
  field.decay = 1;
  m.atoms = 2;
  passes(true); // the field knows no number
  field.atoms = 1;
  CHECK(refused(true) == "c.vdb: the density of 1 atom, expected the mesh's 2");
  field.atoms = 5469;
  CHECK(refused(false) == "c.vdb: the density of 5,469 atoms, expected the mesh's 2");
  m.atoms = 0;
  passes(true); // of a former version, or of a map
  m.atoms = 5469;
  passes(true);
  field.atoms = 1;
  m.source = ""; // of another program
  passes(true);
  m.source = "by hand";
  m.atoms = 0;
  passes(true);
}

TEST_CASE("structures are told apart by their sums where both have one") {
  CHECK(other_structure("1crn.pdb sha256:69ed", "1ubq.pdb sha256:1f46"));
  CHECK_FALSE(other_structure("1crn.pdb sha256:69ed", "renamed.pdb sha256:69ed"));
  CHECK_FALSE(other_structure("by hand", "1ubq.pdb sha256:1f46"));
}
