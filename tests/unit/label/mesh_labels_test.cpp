// mesh_labels_test.cpp — labels in a mesh: which cells have them, named boundaries, and what tetsmooth carries on.
#include "base/error.hpp"
#include "label/mesh_labels.hpp"
#include "label/other_selection.hpp"
#include "label/unseen_residues.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/attribute_transfer.hpp"
#include "unit/mesh/meshes.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

using namespace molmesh;

namespace {

/// A box of 4³ cubes, its left half the molecule; two atoms of two residues there, one above the other.
TetMesh half_box() {
  return testing::cubes(4, [](Vec3i p) { return p.x < 2 ? 1 : 2; });
}

Hierarchy two_residues() {
  Hierarchy h;
  h.level = {{"chain", {{"A", 1, 0, 2}}}, {"residue", {{"GLY:1", 0.3, 0, 1}, {"SER:2", 0.3, 1, 2}}}};
  h.atom = {{{1, 2, 1}, 1}, {{1, 2, 3}, 1}};
  return h;
}

const CellArray& array(const TetMesh& m, const std::string& name) {
  const auto a =
      std::find_if(m.cell_array.begin(), m.cell_array.end(), [&](const CellArray& c) { return c.name == name; });
  REQUIRE(a != m.cell_array.end());
  return *a;
}

double height(const TetMesh& m, size_t cell) {
  double z = 0;
  if (cell < m.tet.size())
    for (const int32_t p : m.tet[cell])
      z += m.point[p].z / 4;
  else
    for (const int32_t p : m.tri[cell - m.tet.size()])
      z += m.point[p].z / 3;
  return z;
}

void label_mesh(TetMesh& m, const std::vector<label::NamedBoundary>& boundary, label::Patches& patches) {
  const Hierarchy h = two_residues();
  const label::Places places = label::places_of(m, 2);
  label::Labels labels = label::find_labels(h, places.centroid, {1, 1, 2});
  patches = label::add_patches(m, places, labels, boundary);
  label::add_labels(m, places, std::move(labels));
}

} // namespace

TEST_CASE("a triangle of several boundaries is the last one's, and it is known who took those of an earlier one") {
  TetMesh m = half_box();
  label::Patches patches;
  label_mesh(m, {{"upper", {0, 1}}, {"lower", {1, 0}}, {"none", {0, 0}}, {"all", {1, 1}}}, patches);
  CHECK(patches.count[0] == 0);
  CHECK(patches.count[3] == std::count(m.boundary.begin(), m.boundary.end(), Boundary::surface));
  CHECK(patches.taken_by == std::vector<std::set<size_t>>{{3}, {3}, {}, {}});
  TetMesh again = half_box();
  label_mesh(again, {{"all", {1, 1}}, {"lower", {1, 0}}, {"upper", {0, 1}}}, patches);
  CHECK(patches.count[0] == 0);
  CHECK(patches.count[1] > 0);
  CHECK(patches.taken_by == std::vector<std::set<size_t>>{{1, 2}, {}, {}});
}

TEST_CASE("triangles of a boundary on walls of closed cavities are counted") {
  TetMesh m = testing::cubes(7, [](Vec3i p) {
    const bool inside = std::min({p.x, p.y, p.z}) >= 1 && std::max({p.x, p.y, p.z}) <= 5;
    return p == Vec3i{3, 3, 3} ? 3 : inside ? 1 : 2;
  });
  label::Patches patches;
  label_mesh(m, {{"all", {1, 1}}, {"none", {0, 0}}}, patches);
  CHECK(patches.count == std::vector<int64_t>{2 * (6 * 25 + 6), 0});
  CHECK(patches.walls == std::vector<int64_t>{2 * 6, 0});
}

TEST_CASE("Molecule and surface are labelled by what is nearest, nothing else is") {
  TetMesh m = half_box();
  label::Patches patches;
  label_mesh(m, {{"upper", {0, 1}}, {"none", {0, 0}}}, patches);
  const CellArray &residue = array(m, "residue"), &atom = array(m, "atom"), &share = array(m, "residue_share"),
                  &patch = array(m, "patch"), &chain = array(m, "chain");
  int64_t upper = 0;
  for (size_t c = 0; c < m.tet.size() + m.tri.size(); ++c) {
    const bool tet = c < m.tet.size();
    const int32_t tag = tet ? m.region[c] : m.boundary[c - m.tet.size()];
    if (tag != 1) {
      CHECK(residue.integer[c] == -1);
      CHECK(share.real[c] == 0);
    } else {
      CHECK(chain.integer[c] == 0);
      CHECK(atom.integer[c] == residue.integer[c]);
      CHECK(share.real[c] >= 0.5 - 1e-6);
      if (std::abs(height(m, c) - 2) > 1e-9)
        CHECK(residue.integer[c] == (height(m, c) > 2));
    }
    const bool named = !tet && tag == 1 && atom.integer[c] == 1;
    upper += named;
    CHECK(patch.integer[c] == (tet ? 0 : named ? 8 : tag));
  }
  CHECK(patches.first == 8);
  CHECK(patches.count == std::vector<int64_t>{upper, 0});
  CHECK(upper == 16);

  CHECK_THROWS_AS(label_mesh(m, {}, patches), Error); // a former run's arrays must go first
}

TEST_CASE("A mesh is labelled anew without a trace of the labels before") {
  TetMesh once = half_box(), twice = half_box();
  label::Patches patches;
  label_mesh(once, {{"all", {1, 1}}, {"upper", {0, 1}}}, patches);
  CHECK(patches.count == std::vector<int64_t>{16, 16}); // later ones win
  label_mesh(twice, {{"x", {1, 0}}}, patches);
  for (const CellArray& a : std::vector<CellArray>(twice.cell_array))
    if (a.name.find("_share") == std::string::npos)
      twice.named_text.push_back({a.name + "_names", ""}); // as the tool adds them
  for (const char* foreign : {"market", "market_share"})
    twice.cell_array.push_back({foreign, std::vector<int32_t>(twice.tet.size() + twice.tri.size(), 5), {}});
  label::remove_labels(twice);
  REQUIRE(twice.cell_array.size() == 3); // patches stay, and what another program has
  label::remove_patches(twice);
  REQUIRE(twice.cell_array.size() == 2);
  label_mesh(twice, {{"all", {1, 1}}, {"upper", {0, 1}}}, patches);
  for (const CellArray& a : once.cell_array) {
    CHECK(array(twice, a.name).integer == a.integer);
    CHECK(array(twice, a.name).real == a.real);
  }
}

TEST_CASE("A level named like an array of the mesh is refused") {
  for (const char* name : {"region", "boundary", "part", "patch", "mine", "residue_share", "atom_share"}) {
    TetMesh m = half_box();
    m.cell_array.push_back({"mine", std::vector<int32_t>(m.tet.size() + m.tri.size()), {}});
    Hierarchy h = two_residues();
    h.level[0].name = name;
    const label::Places places = label::places_of(m, 1);
    CHECK_THROWS_AS(label::add_labels(m, places, label::find_labels(h, places.centroid, {})), Error);
  }
}

TEST_CASE("Values of cells survive a change of the elements: nearest of the same region or label") {
  TetMesh m = half_box();
  label::Patches patches;
  label_mesh(m, {{"upper", {0, 1}}}, patches);
  const TetMesh before = m;
  const AttributeTransfer carried(m);
  CHECK(m.cell_array.empty());
  CHECK(carried.names() == "patch, chain, chain_share, residue, residue_share, atom, atom_share");
  std::mt19937 random(3); // the same cells in another order
  std::vector<size_t> tet(m.tet.size()), tri(m.tri.size());
  std::iota(tet.begin(), tet.end(), size_t{0});
  std::iota(tri.begin(), tri.end(), size_t{0});
  std::shuffle(tet.begin(), tet.end(), random);
  std::shuffle(tri.begin(), tri.end(), random);
  for (size_t t = 0; t < tet.size(); ++t) {
    m.tet[t] = before.tet[tet[t]];
    m.region[t] = before.region[tet[t]];
  }
  for (size_t t = 0; t < tri.size(); ++t) {
    m.tri[t] = before.tri[tri[t]];
    m.boundary[t] = before.boundary[tri[t]];
  }
  carried.put_into(m, 3);
  for (const CellArray& a : before.cell_array) {
    const CellArray& now = array(m, a.name);
    for (size_t c = 0; c < tet.size() + tri.size(); ++c) {
      const size_t from = c < tet.size() ? tet[c] : tet.size() + tri[c - tet.size()];
      if (a.real.empty())
        CHECK(now.integer[c] == a.integer[from]);
      else
        CHECK(now.real[c] == a.real[from]);
    }
  }
}

TEST_CASE("Residues of a boundary without a triangle are named as selections") {
  const TetMesh m = half_box();
  const label::Places places = label::places_of(m, 1);
  Hierarchy h;
  h.level = {{"chain", {{"A", 1, 0, 2}, {"B 1", 1, 2, 3}}},
             {"residue", {{"GLY:1", 0.3, 0, 2}, {"SER:2", 0.3, 2, 3}, {"TYS:63A", 0.3, 3, 4}}}};
  h.atom = {{{1, 2, 1}, 1}, {{1, 2, 3}, 1}, {{1, 2, 2}, 0.01}, {{-30, 2, 2}, 1}};
  const label::Labels labels = label::find_labels(h, places.centroid, {1, 1, 1});
  const auto unseen = [&](const std::vector<uint8_t>& atoms) {
    return label::unseen_residues(h, places, labels, {"x", atoms});
  };
  CHECK(unseen({1, 1, 0, 0}).unseen.empty());
  CHECK(unseen({1, 0, 1, 1}).residues == 3);
  CHECK(unseen({1, 0, 1, 1}).unseen == std::vector<std::string>{"//A/2(SER)", "//\"B 1\"/63A(TYS)"});
  CHECK(unseen({0, 0, 0, 1}).unseen == std::vector<std::string>{"//\"B 1\"/63A(TYS)"});
  // Of a residue of which one atom is selected, the others' triangles do not count.
  h.atom[1].center.x = -30;
  const label::Labels lower = label::find_labels(h, places.centroid, {1, 1, 1});
  CHECK(label::unseen_residues(h, places, lower, {"x", {0, 1, 0, 0}}).unseen ==
        std::vector<std::string>{"//A/1(GLY)"});
  h.level.pop_back();
  CHECK(label::unseen_residues(h, places, labels, {"x", {1, 1, 1, 1}}).residues == 0);
}

TEST_CASE("a hierarchy of as many atoms as the mesh knows is its own, charges without a body counted or not") {
  TetMesh m;
  m.source = "a.pqr sha256:1";
  Hierarchy h = two_residues();
  h.source = m.source;
  h.atom.push_back({{1, 2, 2}, 0, 0.4});
  for (const int64_t atoms : {0, 2, 3}) { // not known, of bodies, of all
    m.atoms = atoms;
    CHECK(label::other_number(h, m).empty());
  }
  m.atoms = 5469;
  CHECK(label::other_number(h, m) == "2 atoms where the mesh has 5,469");
  h.atom[1].radius = 0;
  CHECK(label::other_number(h, m) == "1 atom where the mesh has 5,469");
  h.source = "a.pqr sha256:2"; // another file's atoms say nothing
  CHECK(label::other_number(h, m).empty());
  m.source = h.source = "";
  CHECK(label::other_number(h, m).empty());
}
