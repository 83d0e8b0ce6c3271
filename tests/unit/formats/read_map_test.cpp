// read_map_test.cpp — maps of other programs: byte orders, modes, axes, places, and what is refused.
#include "density/density.hpp"
#include "formats/map/map.hpp"
#include "formats/map/read_map.hpp"
#include "unit/density/oracle.hpp"
#include "unit/refusal.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <sstream>

using namespace molmesh;
using compose::DenseMap;

namespace {

/// A map of 4 x 3 x 5 points, point (i,j,k) with the value i + 10·j + 100·k, written column by column.
struct Ccp4 {
  int32_t mode = 2;
  int axis[3] = {1, 2, 3}; ///< of columns, rows, sections
  int32_t start[3] = {0, 0, 0};
  float cell[3] = {8, 6, 10}, angle[3] = {90, 90, 90}, origin[3] = {0, 0, 0};
  bool swapped = false;
  int32_t symmetry = 0;

  /// Of a whole number from 0 to 2047: binary16.
  static uint16_t half(int v) {
    int exponent = 0;
    while (v >> (exponent + 1) > 0)
      ++exponent;
    return v == 0 ? uint16_t{0} : static_cast<uint16_t>((exponent + 15) << 10 | ((v << (10 - exponent)) & 1023));
  }

  std::string bytes() const {
    const int32_t n[3] = {4, 3, 5};
    std::string out(1024, '\0');
    const auto put = [&](size_t at, auto v) {
      char b[sizeof v];
      std::memcpy(b, &v, sizeof v);
      if (swapped)
        std::reverse(b, b + sizeof v);
      std::memcpy(&out[at], b, sizeof v);
    };
    for (size_t a = 0; a < 3; ++a) {
      put(4 * a, n[axis[a] - 1]);
      put(16 + 4 * a, start[axis[a] - 1]);
      put(28 + 4 * a, n[a]);
      put(40 + 4 * a, cell[a]);
      put(52 + 4 * a, angle[a]);
      put(64 + 4 * a, int32_t{axis[a]});
      put(196 + 4 * a, origin[a]);
    }
    put(12, mode);
    put(92, symmetry);
    out.resize(1024 + static_cast<size_t>(std::max(symmetry, 0)));
    int32_t at[3];
    int32_t& column = at[axis[0] - 1];
    int32_t& row = at[axis[1] - 1];
    int32_t& section = at[axis[2] - 1];
    for (section = 0; section < n[axis[2] - 1]; ++section)
      for (row = 0; row < n[axis[1] - 1]; ++row)
        for (column = 0; column < n[axis[0] - 1]; ++column) {
          const int v = at[0] + 10 * at[1] + (mode == 0 ? 20 : 100) * at[2];
          const size_t size = out.size();
          out.resize(size + (mode == 0 ? 1 : mode == 2 ? 4 : 2));
          if (mode == 0)
            put(size, static_cast<int8_t>(v));
          else if (mode == 1)
            put(size, static_cast<int16_t>(-v));
          else if (mode == 12)
            put(size, half(v));
          else if (mode == 6)
            put(size, static_cast<uint16_t>(v + 60000));
          else
            put(size, static_cast<float>(v));
        }
    return out;
  }
};

std::string refusal(const std::string& bytes) {
  return test::refusal(Status::bad_input, [&] { formats::read_map(bytes, "x.map"); });
}

std::string dx(const std::string& counts = "2 3 2",
               const std::string& values = "0 1 10 11 20 21\n100 101 110 111 120 121\n",
               const std::string& delta = "delta 0 0.5 0\n") {
  return "# a comment\nobject 1 class gridpositions counts " + counts + "\norigin -1 2 3.5\ndelta 0.5 0 0\n" +
         delta + "delta 0 0 0.5\nobject 2 class gridconnections counts " + counts +
         "\nobject 3 class array type double rank 0 items 12 data follows\n" + values +
         "attribute \"dep\" string \"positions\"\n";
}

} // namespace

TEST_CASE("CCP4 maps are read in every mode, byte order and order of axes") {
  for (const bool swapped : {false, true})
    for (const int32_t mode : {0, 1, 2, 6, 12})
      for (const auto& axis : {std::array{1, 2, 3}, {3, 1, 2}, {2, 3, 1}, {3, 2, 1}})
        for (const int32_t symmetry : {0, 160}) {
          Ccp4 c;
          c.swapped = swapped;
          c.mode = mode;
          c.symmetry = symmetry;
          std::copy(axis.begin(), axis.end(), c.axis);
          INFO("mode " << mode << ", swapped " << swapped << ", columns along " << axis[0]);
          const DenseMap m = formats::read_map(c.bytes(), "x.map", 2);
          CHECK(m.points == Vec3i{4, 3, 5});
          CHECK(m.axis[0] == Vec3d{2, 0, 0});
          CHECK(m.axis[1] == Vec3d{0, 2, 0});
          CHECK(m.axis[2] == Vec3d{0, 0, 2});
          const float v = mode == 0 ? 3 + 20 + 80 : 3 + 20 + 400;
          CHECK(m.at({3, 2, 4}) == (mode == 1 ? -v : mode == 6 ? v + 60000 : v));
        }
}

TEST_CASE("the machine stamp tells the byte order where the numbers do not") {
  // 256 columns of bytes are 65,536 in the other order.
  for (const bool swapped : {false, true}) {
    std::string s(1024 + 256 * 2 * 2, '\0');
    const auto put = [&](size_t word, int32_t v) {
      for (size_t k = 0; k < 4; ++k)
        s[4 * (word - 1) + k] = static_cast<char>(v >> (8 * (swapped ? 3 - k : k)));
    };
    for (const auto& [word, v] : {std::pair{1, 256}, {2, 2}, {3, 2}, {8, 256}, {9, 2}, {10, 2}})
      put(static_cast<size_t>(word), v);
    for (const size_t word : {11, 12, 13, 14, 15, 16})
      put(word, 0x42B40000); // 90.f
    s[212] = s[213] = swapped ? '\x11' : '\x44';
    s[1024 + 5] = 7;
    CHECK(formats::read_map(s, "x.map").points == Vec3i{256, 2, 2});
    CHECK(formats::read_map(s, "x.map").at({5, 0, 0}) == 7);
  }
}

TEST_CASE("numbers of 16 bits: small, negative, and none") {
  Ccp4 c;
  c.mode = 12;
  std::string s = c.bytes();
  const auto put = [&](size_t i, uint16_t v) { std::memcpy(&s[1024 + 2 * i], &v, 2); };
  put(0, 0xC100); // -2.5
  put(1, 0x0001); // 2^-24
  const DenseMap m = formats::read_map(s, "x.map");
  CHECK(m.at({0, 0, 0}) == -2.5f);
  CHECK(m.at({1, 0, 0}) == std::ldexp(1.f, -24));
  put(2, 0x7C00);
  CHECK(refusal(s).find("x.map: M6: ") == 0);
}

TEST_CASE("a map lies where its origin says, else where its start says, in cells with any angles") {
  Ccp4 c;
  c.start[0] = -3, c.start[1] = 5, c.start[2] = 7;
  CHECK(formats::read_map(c.bytes(), "x.map").origin == Vec3d{-6, 10, 14});
  c.origin[1] = 2.5;
  CHECK(formats::read_map(c.bytes(), "x.map").origin == Vec3d{0, 2.5, 0});
  c.origin[1] = 0;
  c.angle[2] = 120;
  const DenseMap m = formats::read_map(c.bytes(), "x.map");
  CHECK(norm(m.axis[1] - 2. * Vec3d{-0.5, std::sqrt(0.75), 0}) < 1e-12);
  CHECK(norm(m.origin - (-3. * m.axis[0] + 5. * m.axis[1] + 7. * m.axis[2])) < 1e-12);
}

TEST_CASE("what density2map writes is read back") {
  const Hierarchy h = test::random_chains(1, 4, 5, {0.5, 1}, 3);
  density::Options o;
  o.spacing = 1;
  density::Counts counts;
  const BlockGrid g = to_block_grid(density::compute(h, o, counts), 1);
  const BlockIndex index(g);
  for (const bool as_dx : {false, true}) {
    std::ostringstream out;
    as_dx ? formats::write_dx(out, g, "x") : formats::write_ccp4(out, g, "x");
    const DenseMap m = formats::read_map(out.str(), "x");
    REQUIRE(m.points == g.frame.points);
    CHECK(norm(m.origin - g.frame.position(g.frame.lower)) < 1e-5);
    int64_t differ = 0;
    for (int x = 0; x < m.points.x; ++x)
      for (int y = 0; y < m.points.y; ++y)
        for (int z = 0; z < m.points.z; ++z)
          differ += m.at({x, y, z}) != value_at(g, index, g.frame.lower + Vec3i{x, y, z});
    CHECK(differ == 0);
  }
}

TEST_CASE("bad CCP4 maps are refused by their rule") {
  const std::string good = Ccp4().bytes();
  CHECK(refusal("").find("M1") != std::string::npos);
  CHECK(refusal(good.substr(0, 1000)).find("M1") != std::string::npos);
  CHECK(refusal(good.substr(0, good.size() - 1)).find("M5") != std::string::npos);
  CHECK(refusal(std::string(2000, '\0')).find("M1") != std::string::npos);
  const auto changed = [&](int word, auto v) {
    std::string b = good;
    std::memcpy(&b[4 * (static_cast<size_t>(word) - 1)], &v, 4);
    return refusal(b);
  };
  CHECK(changed(4, int32_t{4}).find("M2") != std::string::npos);
  CHECK(changed(2, int32_t{1}).find("M2") != std::string::npos);
  CHECK(changed(3, int32_t{1 << 23}).find("M5") != std::string::npos);
  CHECK(changed(24, int32_t{-80}).find("M2") != std::string::npos);
  CHECK(changed(17, int32_t{2}).find("M3") != std::string::npos);
  CHECK(changed(11, 0.0f).find("M4") != std::string::npos);
  CHECK(changed(14, 179.5f).find("M4") != std::string::npos);
  CHECK(changed(8, int32_t{0}).find("M4") != std::string::npos);
  CHECK(changed(300, std::nanf("")).find("M6") != std::string::npos);
}

TEST_CASE("OpenDX grids are read, and bad ones refused by their rule and line") {
  const DenseMap m = formats::read_map(dx(), "x.dx");
  CHECK(m.points == Vec3i{2, 3, 2});
  CHECK(m.origin == Vec3d{-1, 2, 3.5});
  CHECK(m.at({1, 2, 1}) == 121);
  CHECK(m.at({1, 0, 0}) == 100);
  const auto line = [](const std::string& text) {
    return test::refusal(Status::bad_input, [&] { formats::read_map(text, "x.dx"); });
  };
  CHECK(line("nothing here\n").find("x.dx:1: D1") == 0);
  CHECK(line(dx("2 3")).find("x.dx:2: D2") == 0);
  CHECK(line(dx("2 3 3")).find("D2") != std::string::npos);
  CHECK(line(dx("2 3 2", "1 2 3\n")).find("D4") != std::string::npos);
  CHECK(line(dx("2 3 2", "0 1 10 11 20 21\n100 101 110 111 120 nan\n")).find("x.dx:10: D4") == 0);
  CHECK(line(dx("2 3 2", "0 1 10 11 20 21\n100 101 110 111 120 121 122\n")).find("D4") != std::string::npos);
  CHECK(line(dx("2000 3000 2000")).find("D4") != std::string::npos);
  CHECK(line(dx("2 3 2", "0 1 10 11 20 21\n100 101 110 111 120 121\n", "delta 0.5 0 0\n")).find("D3") !=
        std::string::npos);
  CHECK(line("object 1 class array items 3 data follows\n").find("D1") != std::string::npos);
}

TEST_CASE("gzipped maps are unpacked, and cut ones refused") {
  CHECK(refusal(std::string("\x1f\x8b\x08 not gzip", 12)).find("G1") != std::string::npos);
}
