// synthetic_map.cpp — a map as cryo-EM would show a structure: a Gaussian for each atom, blurred to a resolution.
// synthetic_map STRUCTURE.hier RESOLUTION SPACING OUT.map prints the level at which the map encloses 1.21 Å³ for
// each dalton, and the volume that it encloses there, by subdivision of the voxels that the trilinear contour
// crosses.
#include "formats/hier/hier.hpp"
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <vector>

using namespace molmesh;

namespace {

struct Map {
  Vec3i n;
  Vec3d origin;
  double h;
  std::vector<float> value;
  float& at(int x, int y, int z) { return value[size_t(x) + size_t(n.x) * (size_t(y) + size_t(n.y) * size_t(z))]; }
};

double weight(const std::string& element) {
  return element == "H"   ? 1
         : element == "C" ? 6
         : element == "N" ? 7
         : element == "O" ? 8
         : element == "P" ? 15
                          : 16;
}

Map blurred(const Hierarchy& h, double resolution, double spacing) {
  const double sigma = 0.225 * resolution, reach = 4 * sigma;
  Vec3d lo = h.atom[0].center, hi = lo;
  for (const Atom& a : h.atom)
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], a.center[k]);
      hi[k] = std::max(hi[k], a.center[k]);
    }
  Map m;
  m.h = spacing;
  m.origin = lo - Vec3d{reach, reach, reach};
  for (int k = 0; k < 3; ++k)
    m.n[k] = static_cast<int>(std::ceil((hi[k] - lo[k] + 2 * reach) / spacing)) + 1;
  m.value.resize(size_t(m.n.x) * size_t(m.n.y) * size_t(m.n.z));
  for (const Atom& a : h.atom) {
    std::vector<double> g[3];
    Vec3i first;
    for (int k = 0; k < 3; ++k) {
      const double c = (a.center[k] - m.origin[k]) / spacing;
      first[k] = std::max(0, static_cast<int>(std::ceil(c - reach / spacing)));
      for (int i = first[k]; i < m.n[k] && i <= c + reach / spacing; ++i)
        g[k].push_back(std::exp(-0.5 * std::pow((i - c) * spacing / sigma, 2)));
    }
    const double w = weight(h.names[a.element]);
    for (size_t z = 0; z < g[2].size(); ++z)
      for (size_t y = 0; y < g[1].size(); ++y)
        for (size_t x = 0; x < g[0].size(); ++x)
          m.at(first.x + int(x), first.y + int(y), first.z + int(z)) +=
              static_cast<float>(w * g[0][x] * g[1][y] * g[2][z]);
  }
  return m;
}

double enclosed(Map& m, float level) {
  constexpr int parts = 6;
  double voxels = 0;
  for (int z = 0; z + 1 < m.n.z; ++z)
    for (int y = 0; y + 1 < m.n.y; ++y)
      for (int x = 0; x + 1 < m.n.x; ++x) {
        float v[8];
        int in = 0;
        for (int k = 0; k < 8; ++k)
          in += (v[k] = m.at(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2))) > level;
        if (in == 0 || in == 8) {
          voxels += in / 8;
          continue;
        }
        int inside = 0;
        for (int s = 0; s < parts * parts * parts; ++s) {
          const double t[3] = {(s % parts + 0.5) / parts, (s / parts % parts + 0.5) / parts,
                               (s / parts / parts + 0.5) / parts};
          double sum = 0;
          for (int k = 0; k < 8; ++k)
            sum += v[k] * (k & 1 ? t[0] : 1 - t[0]) * (k & 2 ? t[1] : 1 - t[1]) * (k & 4 ? t[2] : 1 - t[2]);
          inside += sum > level;
        }
        voxels += double(inside) / (parts * parts * parts);
      }
  return voxels * m.h * m.h * m.h;
}

void write(const Map& m, const char* name) {
  std::vector<char> header(1024);
  const auto put = [&](int word, auto v) { std::memcpy(&header[size_t(4 * (word - 1))], &v, 4); };
  for (int a = 0; a < 3; ++a) {
    put(1 + a, int32_t{m.n[a]});
    put(8 + a, int32_t{m.n[a]});
    put(11 + a, static_cast<float>(m.h * m.n[a]));
    put(14 + a, 90.0f);
    put(17 + a, int32_t{a + 1});
    put(50 + a, static_cast<float>(m.origin[a]));
  }
  put(4, int32_t{2});
  std::memcpy(&header[208], "MAP ", 4);
  std::memcpy(&header[212], "\x44\x44\0\0", 4);
  std::ofstream out(name, std::ios::binary);
  out.write(header.data(), 1024);
  out.write(reinterpret_cast<const char*>(m.value.data()), static_cast<std::streamsize>(4 * m.value.size()));
}

} // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "synthetic_map STRUCTURE.hier RESOLUTION SPACING OUT.map\n");
    return 2;
  }
  std::ifstream in(argv[1]);
  const Hierarchy h = formats::read_hier(in, argv[1]);
  Map m = blurred(h, std::atof(argv[2]), std::atof(argv[3]));
  double mass = 0;
  for (const Atom& a : h.atom)
    mass += 2 * weight(h.names[a.element]) * (h.names[a.element] == "H" ? 0.5 : 1);
  std::vector<float> sorted = m.value;
  const auto k = static_cast<std::ptrdiff_t>(std::min(1.21 * mass / std::pow(m.h, 3), 0.9 * double(sorted.size())));
  std::nth_element(sorted.begin(), sorted.begin() + k, sorted.end(), std::greater<>());
  const float level = sorted[size_t(k)];
  write(m, argv[4]);
  std::printf("level %.9g volume %.6g\n", double(level), enclosed(m, level));
}
