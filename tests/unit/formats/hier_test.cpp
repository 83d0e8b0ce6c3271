// hier_test.cpp — the rules of HIERv1.md and HIERv2.md, the exact round trip.
#include "base/error.hpp"
#include "formats/hier/hier.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

using namespace molmesh;
namespace fs = std::filesystem;

namespace {

Hierarchy read_text(const std::string& text) {
  std::istringstream in(text);
  return formats::read_hier(in, "x.hier");
}

std::string written(const Hierarchy& h) {
  std::ostringstream out;
  formats::write_hier(out, h);
  return out.str();
}

std::vector<fs::path> samples(const char* folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(MOLMESH_SOURCE_DIR) / "formats/hier/samples" / folder))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

uint64_t bits(double v) {
  uint64_t b;
  std::memcpy(&b, &v, sizeof b);
  return b;
}

/// Same values to the last bit, names by text.
void check_same(const Hierarchy& a, const Hierarchy& b) {
  CHECK(a.source == b.source);
  REQUIRE(a.level.size() == b.level.size());
  for (size_t l = 0; l < a.level.size(); ++l) {
    CHECK(a.level[l].name == b.level[l].name);
    REQUIRE(a.level[l].group.size() == b.level[l].group.size());
    for (size_t g = 0; g < a.level[l].group.size(); ++g) {
      const Group &x = a.level[l].group[g], &y = b.level[l].group[g];
      REQUIRE((x.name == y.name && bits(x.exponent) == bits(y.exponent) && bits(x.weight) == bits(y.weight) &&
               x.begin == y.begin && x.end == y.end));
    }
  }
  REQUIRE(a.body.size() == b.body.size());
  for (size_t i = 0; i < a.body.size(); ++i) {
    const Body &x = a.body[i], &y = b.body[i];
    CHECK((x.shape == y.shape && x.center == y.center && x.u == y.u && x.v == y.v && x.size == y.size &&
           x.skin == y.skin && x.atom == y.atom));
  }
  REQUIRE(a.atom.size() == b.atom.size());
  for (size_t i = 0; i < a.atom.size(); ++i) {
    const Atom &x = a.atom[i], &y = b.atom[i];
    REQUIRE(a.names[x.name] == b.names[y.name]);
    REQUIRE(a.names[x.element] == b.names[y.element]);
    for (int axis = 0; axis < 3; ++axis)
      REQUIRE(bits(x.center[axis]) == bits(y.center[axis]));
    REQUIRE(bits(x.radius) == bits(y.radius));
    REQUIRE(((std::isnan(x.charge) && std::isnan(y.charge)) || bits(x.charge) == bits(y.charge)));
  }
}

std::string message(const std::string& text) {
  return test::refusal(Status::bad_input, [&] { read_text(text); });
}

} // namespace

TEST_CASE("every sample in failed/ breaks the rule it is named after") {
  const auto files = samples("failed");
  REQUIRE(files.size() >= 12);
  std::vector<bool> seen(14, false);
  for (const fs::path& path : files) {
    INFO(path.filename().string());
    std::ifstream in(path, std::ios::binary);
    const std::string rule = path.filename().string().substr(0, path.filename().string().find('-'));
    seen.at(static_cast<size_t>(std::stoi(rule.substr(1)))) = true;
    const std::string what = test::refusal(Status::bad_input, [&] { formats::read_hier(in, "F"); });
    REQUIRE(what.substr(0, 2) == "F:");
    CHECK(what.find(": " + rule + ": ") == what.find(':', 2));
    CHECK(what.find("expected") != std::string::npos);
  }
  for (size_t rule = 1; rule <= 13; ++rule)
    CHECK(seen[rule]);
}

TEST_CASE("every sample in passed/ is read, and its canonical form is a fixed point") {
  const auto files = samples("passed");
  REQUIRE(files.size() >= 5);
  for (const fs::path& path : files) {
    INFO(path.filename().string());
    std::ifstream in(path, std::ios::binary);
    const Hierarchy h = formats::read_hier(in, path.string());
    CHECK_NOTHROW(check(h, "h"));
    const std::string text = written(h);
    const Hierarchy again = read_text(text);
    check_same(h, again);
    CHECK(written(again) == text);
  }
}

TEST_CASE("a file of two levels is read as it stands") {
  const Hierarchy h =
      read_text("hier 1\nsource a b\nlevels chain residue\nchain A%20 1\nresidue G:1 0.5\natom N N 12.345 "
                "1.000 -3.2 1.55\natom CA C 1 2 3 1.7 0.12\nchain B 2\nresidue G:1 1\natom N N 1 1 1 1\n");
  CHECK(h.source == "a b");
  REQUIRE(h.level.size() == 2);
  CHECK(h.level[0].group[0].name == "A ");
  CHECK(h.level[0].group[1].begin == 1);
  CHECK(h.level[1].group[0].end == 2);
  CHECK(h.level[1].group[0].exponent == 0.5);
  CHECK(h.atom[0].center == Vec3d{12.345, 1, -3.2});
  CHECK(std::isnan(h.atom[0].charge));
  CHECK(h.atom[1].charge == 0.12);
  CHECK(h.names[h.atom[1].name] == "CA");
  CHECK(h.names[h.atom[1].element] == "C");
}

TEST_CASE("a group has a weight in version 2, and no other needs that version") {
  const std::string text =
      "hier 2\nlevels chain\nchain A 0.4 0.62\natom C C 0 0 0 1\nchain B 0.4\natom C C 4 0 0 1\n";
  const Hierarchy h = read_text(text);
  CHECK(h.level[0].group[0].weight == 0.62);
  CHECK(h.level[0].group[1].weight == 1);
  CHECK(written(h) == text);
  CHECK(message("hier 1\nlevels chain\nchain A 0.4 0.62\natom C C 0 0 0 1\n") ==
        "x.hier:3: R6: found '0.62' more, expected 'LEVEL NAME P'");
  CHECK(message("hier 2\nlevels chain\nchain A 0.4 2000\natom C C 0 0 0 1\n") ==
        "x.hier:3: R9: found '2000', expected the weight, from 0.001 to 1000");
}

TEST_CASE("messages name the file, the line and what was expected") {
  CHECK(message("hier 1\nlevels chain\nchain A 1\natom C C 0 0 nan 1\n") ==
        "x.hier:4: R8: found 'nan', expected z, a finite decimal number");
  CHECK(message("hier 1\nlevels chain residue\nchain A 1\natom C C 0 0 0 1\n") ==
        "x.hier:4: R10: found an atom outside any residue, expected every level open");
  CHECK(message("hier 3\n") == "x.hier:1: R2: found version '3', expected 1 or 2: this reader knows no other");
}

TEST_CASE("random hierarchies read back to the last bit, whatever the block boundaries") {
  std::mt19937_64 random(11);
  const auto any_double = [&] { // any finite bit pattern
    for (;;) {
      const uint64_t b = random();
      double v;
      std::memcpy(&v, &b, sizeof v);
      if (std::isfinite(v))
        return v;
    }
  };
  const auto within = [&](double limit) { // the limits of R8 and R9
    for (;;)
      if (const double v = any_double(); std::abs(v) <= limit)
        return v;
  };
  const auto positive = [&] { return std::max(std::abs(within(1000)), 5e-324); };
  const auto exponent = [&] { return 0.01 + 31 * double(random() >> 11) * 0x1p-53; }; // products are in range, too
  const auto any_name = [&] {
    std::string s(1 + random() % 12, 'x');
    for (char& c : s)
      c = random() % 3 ? static_cast<char>('A' + random() % 50) : static_cast<char>(random());
    return s;
  };
  Hierarchy h;
  h.source = "random é";
  h.level = {{"domain", {}}, {"chain", {}}};
  for (int d = 0; d < 40; ++d) {
    Group domain{any_name(), exponent(), static_cast<int64_t>(h.level[1].group.size()), 0};
    for (uint64_t c = 0; c <= random() % 4; ++c) {
      Group chain{any_name(), exponent(), static_cast<int64_t>(h.atom.size()), 0};
      for (uint64_t left = 1 + random() % 700; left > 0; --left) {
        Atom atom;
        const bool plain = random() % 2; // three decimals, or any double
        for (int axis = 0; axis < 3; ++axis)
          atom.center[axis] =
              plain ? static_cast<double>(static_cast<int64_t>(random() % 2000000) - 1000000) / 1000 : within(1e7);
        if (random() % 50 == 0)
          atom.center.x = -0.0;
        atom.radius = plain ? 1.7 : positive();
        if (random() % 2)
          atom.charge = any_double();
        atom.name = h.names.add(any_name());
        atom.element = h.names.add("C");
        h.atom.push_back(atom);
      }
      chain.end = static_cast<int64_t>(h.atom.size());
      h.level[1].group.push_back(chain);
    }
    domain.end = static_cast<int64_t>(h.level[1].group.size());
    h.level[0].group.push_back(domain);
  }
  const std::string text = written(h);
  REQUIRE(text.size() > (size_t{2} << 20)); // several blocks
  check_same(h, read_text(text));
}

TEST_CASE("three decimals are written as three decimals") {
  const auto number = [](double v) {
    std::ostringstream out;
    formats::HierWriter writer(out, "", {});
    writer.atom("C", "C", {v, 0, 0}, 1, std::nan(""));
    writer.finish();
    const std::string text = out.str();
    const size_t at = text.find("atom C C ") + 9;
    return text.substr(at, text.find(' ', at) - at);
  };
  CHECK(number(12.345) == "12.345");
  CHECK(number(-0.05) == "-0.05");
  CHECK(number(100) == "100");
  CHECK(number(-7.5) == "-7.5");
  CHECK(number(0.001) == "0.001");
  CHECK(number(1e-4) == "1e-04");
  CHECK(std::stod(number(0.1 + 0.2)) == 0.1 + 0.2);
}

TEST_CASE("numbers of every length and form are those of strtod, the last bit too") {
  std::vector<std::string> texts = {"0",        "-0",      "-0.0",      "5.",        ".5",      "-.5",
                                    "00012.50", "1234567", "123456.7",  "1234567.8", "1e-3",    "-1E+4",
                                    "1.5e2",    "0.1",     "9.9999999", "1e-300",    "4.9e-324"};
  std::mt19937 random(3);
  for (int i = 0; i < 20'000; ++i) { // with a point anywhere, or none
    std::string t;
    const auto n = 1 + random() % 18, point = random() % (n + 1);
    for (unsigned k = 0; k < n; ++k)
      t += std::string(k == point ? "." : "") + static_cast<char>('0' + random() % 10);
    if (std::abs(std::stod(t)) <= 1e7)
      texts.push_back((random() % 2 ? "-" : "") + t);
  }
  std::string text = "hier 1\nlevels\n";
  for (size_t i = 0; i < texts.size(); ++i)
    text += "atom C" + std::to_string(i % 100) + (i % 3 ? " C " : "\tC  ") + texts[i] + (i % 5 ? " " : " \t") +
            texts[texts.size() - 1 - i] + " 0 1.5" + (i % 7 ? "\n" : " " + texts[i] + " \n");
  const Hierarchy h = read_text(text);
  REQUIRE(h.atom.size() == texts.size());
  for (size_t i = 0; i < texts.size(); ++i) {
    INFO(texts[i]);
    REQUIRE(bits(h.atom[i].center.x) == bits(std::strtod(texts[i].c_str(), nullptr)));
    REQUIRE(bits(h.atom[i].center.y) == bits(std::strtod(texts[texts.size() - 1 - i].c_str(), nullptr)));
    REQUIRE((i % 7 ? std::isnan(h.atom[i].charge) : bits(h.atom[i].charge) == bits(h.atom[i].center.x)));
    REQUIRE(h.names[h.atom[i].name] == "C" + std::to_string(i % 100));
  }
}

TEST_CASE("what looks like an atom and is none is refused in the rule's words") {
  const auto of_line = [](const std::string& line) {
    return message("hier 1\nlevels\natom C C 0 0 0 1\n" + line + "\n");
  };
  for (const char* x : {".", "-", "-.", "+1", "1.2.3", "1-2", "--1", "1e", "0x10", "1,5", "inf", "nan", "1e999",
                        "12345678901234567x"})
    CHECK(of_line("atom C C " + std::string(x) + " 0 0 1") ==
          "x.hier:4: R8: found '" + std::string(x) + "', expected x, a finite decimal number");
  CHECK(of_line("atom C C 0 0 10000001 1") ==
        "x.hier:4: R8: found '10000001', expected z of at most 1e7 Å in magnitude");
  CHECK(of_line("atom C C 0 0 0 0") == "x.hier:4: R9: found '0', expected the radius > 0");
  CHECK(of_line("atom C C 0 0 0 -1") == "x.hier:4: R9: found '-1', expected the radius > 0");
  CHECK(of_line("atom C C 0 0 0 10001") == "x.hier:4: R9: found '10001', expected the radius of at most 10000 Å");
  CHECK(of_line("atom C C 0 0 0") == "x.hier:4: R6: the line ends, expected the radius");
  CHECK(of_line("atom C") == "x.hier:4: R6: the line ends, expected the element");
  CHECK(of_line("atom ") == "x.hier:4: R6: the line ends, expected the atom's name");
  CHECK(of_line("atom C C 0 0 0 1 0 0") ==
        "x.hier:4: R6: found '0' more, expected 'atom NAME ELEMENT X Y Z RADIUS [CHARGE]'");
  CHECK(of_line("atom C% C 0 0 0 1") == "x.hier:4: R7: found 'C%25', expected % with two hexadecimal digits");
  CHECK(of_line("atomC C 0 0 0 1").find("x.hier:4: R5: found 'atomC'") == 0);
  CHECK(of_line("atom C C 0 0 0 1\r").find("x.hier:4: R1: found a carriage return") == 0);
}

TEST_CASE("a wrong line is named by its number wherever the reader's blocks end") {
  constexpr size_t block = size_t{1} << 18;
  const std::string line = "atom CA C 12.345 -6.789 101.112 1.7\n";
  std::string text = "hier 1\nlevels chain\nchain A 0.5\n";
  const size_t atoms = (block - text.size()) / line.size();
  for (size_t i = 0; i + 1 < atoms; ++i)
    text += line;
  const std::string wrong = "atom CA C 12.345 -6.789 101.112x 1.7\n";
  for (size_t shift = 0; shift < 3 * line.size(); ++shift) {
    std::string t = text + "#" + std::string(shift, '-') + "\n";
    REQUIRE(read_text(t + line + line).atom.size() == atoms + 1);
    const std::string at = "x.hier:" + std::to_string(atoms + 4), next = "x.hier:" + std::to_string(atoms + 5);
    const std::string said = ": R8: found '101.112x', expected z, a finite decimal number";
    CHECK(message(t + wrong + line) == at + said);
    CHECK(message(t + line + wrong) == next + said);
    CHECK(message(t + "chain B 1\nchain C 1\n") == next + ": R11: chain 'B' ends without an atom, expected one");
    CHECK(message(t + line + "atom CA C 1") ==
          next + ": R1: the last line 'atom CA C 1' has no end, expected a complete file");
  }
}

TEST_CASE("any prefix of a file is refused or read, never worse") {
  const std::string text =
      "hier 1\nsource s\nlevels chain residue\nchain A 1\nresidue G%20:1 0.5\natom N N 12.345 1 -3.2 "
      "1.55\natom CA C 1 2 3 1.7 0.12\nchain B 2\nresidue G:1 1\natom N N 1 1 1 1\n";
  int read = 0;
  for (size_t n = 0; n <= text.size(); ++n)
    read += message(text.substr(0, n)).empty();
  CHECK(read == 3); // only the cuts right after an atom line can be read
}

TEST_CASE("a writer refuses what no reader takes") {
  std::ostringstream out;
  Hierarchy h;
  CHECK_THROWS_AS(formats::write_hier(out, h), Error);
  h.atom.push_back({{0, 0, 0}, 1});
  CHECK_NOTHROW(formats::write_hier(out, h));
  h.level = {{"a b", {{"A", 1, 0, 1}}}};
  CHECK_THROWS_AS(formats::write_hier(out, h), Error);
  h.level[0].name = "atom";
  CHECK_THROWS_AS(formats::write_hier(out, h), Error);
}

TEST_CASE("version 2 is written where an atom of radius 0 needs it, and only there") {
  const std::string head = " 2\nlevels chain\nchain A 1\natom O O 0 0 0 1.5 -0.4\natom H H 1 0 0 ";
  const Hierarchy whole = read_text("hier" + head + "1 0.4\n"), charge = read_text("hier" + head + "0 0.4\n");
  CHECK(written(whole).substr(0, 7) == "hier 1\n");
  CHECK(written(charge).substr(0, 7) == "hier 2\n");
  CHECK(charge.atom[1].radius == 0);
  CHECK(charge.atom[1].charge == 0.4);
  CHECK(message("hier 1\nlevels\natom H H 1 0 0 0 0.4\n").find("x.hier:3: R9: ") == 0);
}
