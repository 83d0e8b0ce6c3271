// join_test.cpp — joined hierarchies against atoms that are moved one by one, carving against all pairs.
#include "molecule/join.hpp"
#include "unit/density/completeness.hpp"
#include "unit/refusal.hpp"
#include <cstring>
#include <set>

using namespace molmesh;

namespace {

std::shared_ptr<const Hierarchy> chains(unsigned seed, const char* first = "A") {
  Hierarchy h = test::random_chains(2, 8, 6, {0.3, 1}, seed);
  h.level[0].name = "chain";
  h.level[1].name = "residue";
  for (size_t c = 0; c < h.level[0].group.size(); ++c)
    h.level[0].group[c].name = std::string(1, static_cast<char>(first[0] + c));
  for (size_t r = 0; r < h.level[1].group.size(); ++r)
    h.level[1].group[r].name = (r % 3 ? "SOL:" : "POPC:") + std::to_string(r);
  return std::make_shared<const Hierarchy>(std::move(h));
}

Piece piece(std::shared_ptr<const Hierarchy> h, const char* where) {
  Piece p;
  p.hierarchy = std::move(h);
  p.where = where;
  return p;
}

const Rigid turn = translation({3, -4.5, 20.25}) * rotation({1, 2, -0.5}, 77, {5, 0, 1});

std::string names(const Hierarchy& h, size_t l) {
  std::string text;
  for (const Group& g : h.level[l].group)
    text += (text.empty() ? "" : " ") + g.name;
  return text;
}

std::string refusal(const std::vector<Piece>& pieces, Clash clash = Clash::refuse) {
  std::vector<Joined> joined;
  return test::refusal(Status::bad_input, [&] { join(pieces, clash, joined); });
}

} // namespace

TEST_CASE("rotations turn as they say, multiples of 90° exactly") {
  CHECK(rotation({0, 0, 2}, 90, {})({1, 2, 3}) == Vec3d{-2, 1, 3});
  CHECK(rotation({1, 0, 0}, -90, {})({1, 2, 3}) == Vec3d{1, 3, -2});
  CHECK(rotation({0, 1, 0}, 540, {1, 0, 0})({1, 2, 3}) == Vec3d{1, 2, -3});
  CHECK(norm(rotation({1, 1, 1}, 120, {})({1, 2, 3}) - Vec3d{3, 1, 2}) < 1e-14);
  CHECK(norm(rotation({1, 1, 1}, 120, {7, 7, 7})({7, 7, 7}) - Vec3d{7, 7, 7}) < 1e-14);
  CHECK(is_rotation(turn, 1e-14));
  Rigid mirror = turn;
  mirror.row[1] = -mirror.row[1];
  CHECK(!is_rotation(mirror, 0.01));
  Rigid wide = turn;
  wide.row[0] = 1.1 * wide.row[0];
  CHECK(!is_rotation(wide, 0.01));
}

TEST_CASE("a structure joined with itself moved has the atoms moved by hand, to the last bit, and their density") {
  const std::shared_ptr<const Hierarchy> h = chains(7);
  std::vector<Piece> pieces = {piece(h, "P:1"), piece(h, "P:2")};
  pieces[1].copies = {turn};
  pieces[1].rename = {{"A", "X"}, {"B", "A_1"}};
  std::vector<Joined> joined;
  const Hierarchy both = join(pieces, Clash::refuse, joined);
  check(both, "both");
  CHECK(names(both, 0) == "A B X A_1");
  REQUIRE(both.atom.size() == 2 * h->atom.size());
  for (size_t a = 0; a < h->atom.size(); ++a) {
    CHECK(std::memcmp(&both.atom[a].center, &h->atom[a].center, sizeof(Vec3d)) == 0);
    const Vec3d p = h->atom[a].center;
    Vec3d moved;
    for (int i = 0; i < 3; ++i)
      moved[i] = turn.row[i].x * p.x + turn.row[i].y * p.y + turn.row[i].z * p.z + turn.t[i];
    CHECK(std::memcmp(&both.atom[h->atom.size() + a].center, &moved, sizeof moved) == 0);
  }
  CHECK(joined[1].atoms == static_cast<int64_t>(h->atom.size()));

  Hierarchy moved = *h; // the field of the moved file, found by moving back, is that of the copy
  for (Atom& a : moved.atom)
    a.center = turn(a.center);
  Piece alone = piece(h, "P:1");
  alone.copies = {turn};
  density::Options o;
  o.spacing = 0.9;
  const Hierarchy copy = join({alone}, Clash::refuse, joined);
  test::check_equal(test::compute(copy, o), test::compute(moved, o));
  CHECK(test::worst_error(moved, test::compute(copy, o), 200) <= 1);
  CHECK(test::worst_error(both, test::compute(both, o), 200) <= 1);
}

TEST_CASE("copies are numbered, domains are shared, exponents are set") {
  std::vector<Piece> pieces = {piece(chains(1), "P:1"), piece(chains(2, "L"), "P:2"), piece(chains(3, "X"), "P:3")};
  pieces[0].domain = "protein";
  pieces[1].domain = "membrane";
  pieces[1].copies = {translation({30, 0, 0}), translation({60, 0, 0}), translation({90, 0, 0})};
  pieces[1].residue = 0.7;
  pieces[1].domain_exponent = 0.5;
  pieces[2].domain = "protein";
  pieces[2].chain = 2;
  pieces[2].prefix = "p";
  pieces[2].suffix = "'";
  std::vector<Joined> joined;
  const Hierarchy h = join(pieces, Clash::refuse, joined);
  check(h, "h");
  CHECK(names(h, 0) == "protein membrane");
  CHECK(names(h, 1) == "A B pX' pY' L_1 M_1 L_2 M_2 L_3 M_3");
  CHECK(h.level[0].group[0].exponent == 1);
  CHECK(h.level[0].group[1].exponent == 0.5);
  CHECK(h.level[1].group[0].exponent == 1);
  CHECK(h.level[1].group[2].exponent == 2);
  CHECK(h.level[2].group[0].exponent == 0.3);
  CHECK(h.level[2].group.back().exponent == 0.7);
  CHECK(joined[1].copies == 3);
  CHECK(h.atom.size() == 5 * pieces[0].hierarchy->atom.size());

  // The joined one as a piece, with its own domains.
  const auto whole = std::make_shared<const Hierarchy>(h);
  CHECK(refusal({piece(whole, "P:1"), piece(whole, "P:2")}).find("P:1: found domain 'protein' more than once") ==
        0);
  const Hierarchy twice = join({piece(whole, "P:1"), piece(whole, "P:2")}, Clash::number, joined);
  CHECK(names(twice, 0) == "protein_1 membrane_1 protein_2 membrane_2");
  CHECK(std::set<std::string>{"A_1", "A_2", "L_1_1"}.size() == 3);
  CHECK(names(twice, 1).substr(0, 7) == "A_1 B_1");
}

TEST_CASE("weights go along, and residues whose exponent is set have none") {
  const auto weighted = std::make_shared<const Hierarchy>(test::with_weights(*chains(1), 2));
  std::vector<Piece> pieces = {piece(weighted, "P:1"), piece(weighted, "P:2")};
  pieces[1].residue = 0.7;
  pieces[1].prefix = "second";
  std::vector<Joined> joined;
  const Hierarchy h = join(pieces, Clash::refuse, joined);
  for (size_t l = 0; l < 2; ++l) {
    const std::vector<Group>&from = weighted->level[l].group, &to = h.level[l].group;
    REQUIRE(to.size() == 2 * from.size());
    for (size_t g = 0; g < from.size(); ++g) {
      CHECK(to[g].weight == from[g].weight);
      CHECK(to[from.size() + g].weight == (l == 0 ? from[g].weight : 1));
    }
  }
  for (Piece& p : pieces)
    p.domain = "all";
  Hierarchy domains = join(pieces, Clash::refuse, joined);
  CHECK(domains.level[0].group[0].weight == 1);
  domains.level[0].group[0].weight = 0.8;
  const Hierarchy again = join({piece(std::make_shared<const Hierarchy>(domains), "P:1")}, Clash::refuse, joined);
  CHECK(again.level[0].group[0].weight == 0.8);
  density::Options o;
  o.spacing = 1.1;
  CHECK(test::worst_error(h, test::compute(h, o), 200) <= 1);
}

TEST_CASE("carving leaves out the residues that lie near earlier pieces") {
  for (const double distance : {0.8, 2.5, 3.5}) {
    std::vector<Piece> pieces = {piece(chains(4), "P:1"), piece(chains(5, "L"), "P:2"),
                                 piece(chains(6, "X"), "P:3")};
    pieces[1].copies = {Rigid{}, translation({0, 8, 0})};
    pieces[1].carve = distance;
    pieces[2].carve = distance;
    std::vector<Joined> joined;
    const Hierarchy h = join(pieces, Clash::refuse, joined);
    check(h, "h");
    // By all pairs.
    std::vector<Vec3d> before, kept;
    for (const Piece& p : pieces) {
      before = kept;
      std::map<std::string, int64_t> carved;
      for (const Rigid& at : p.copies)
        for (const Group& r : p.hierarchy->level[1].group) {
          bool near = false;
          for (int64_t a = r.begin; a < r.end; ++a)
            for (const Vec3d& q : before)
              near = near || norm2(at(p.hierarchy->atom[a].center) - q) <= p.carve * p.carve;
          if (near && p.carve > 0) {
            ++carved[r.name.substr(0, r.name.find(':'))];
            continue;
          }
          for (int64_t a = r.begin; a < r.end; ++a)
            kept.push_back(at(p.hierarchy->atom[a].center));
        }
      CHECK(carved == joined[&p - pieces.data()].carved);
    }
    REQUIRE(kept.size() == h.atom.size());
    for (size_t a = 0; a < kept.size(); ++a)
      REQUIRE(kept[a] == h.atom[a].center);
  }
}

TEST_CASE("pieces that do not fit are refused in their line") {
  const std::shared_ptr<const Hierarchy> h = chains(7);
  CHECK(refusal({piece(h, "P:1"), piece(h, "P:2")}) ==
        "P:2: found chain 'A', which P:1 has, too, expected other names[clash]");
  std::vector<Joined> joined;
  CHECK(names(join({piece(h, "P:1"), piece(h, "P:2")}, Clash::number, joined), 0) == "A_1 B_1 A_2 B_2");
  const auto plain = std::make_shared<const Hierarchy>(test::random_chains(1, 3, 4, {0.3}, 1));
  CHECK(refusal({piece(h, "P:1"), piece(plain, "P:2")}) ==
        "P:2: found levels level0, expected chain,residue as of the first piece");
  Piece other = piece(h, "P:2");
  other.rename = {{"Q", "R"}};
  CHECK(refusal({other}) == "P:2: found no chain 'Q' to call 'R', expected its name in the piece");
  other.rename = {{"A", "C"}, {"B", "D"}};
  other.carve = 1;
  CHECK(refusal({piece(h, "P:1"), other}).find("P:2: all of the piece is carved away") == 0);
  other.carve = 0;
  other.copies = {translation({9.9999999e6, 0, 0}), translation({2e7, 0, 0})};
  CHECK(refusal({other}) == "P:2: an atom is moved beyond 1e7 Å, expected it nearer to the origin");
  other.copies = {Rigid{}};
  other.domain = "d";
  CHECK(refusal({piece(h, "P:1"), other}) == "P:1: found no domain, expected one: other pieces have some");
}
