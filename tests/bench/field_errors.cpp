// field_errors.cpp — values of the band against the sum over all atoms in double precision (I1), for six settings
// of exponents. field_errors FILE.hier SPACING TOLERANCE POINTS: the worst error, as a part of ε·max(1, G).
#include "density/density.hpp"
#include "formats/hier/hier.hpp"
#include "unit/density/oracle.hpp"
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <fstream>

using namespace molmesh;

namespace {

struct Sample {
  Vec3i point;
  float value;
};

/// The n-th active point of the band, in order.
Sample active_point(const Band& band, const std::vector<int64_t>& before, int64_t n) {
  const auto b = static_cast<size_t>(std::upper_bound(before.begin(), before.end(), n) - before.begin()) - 1;
  const BandBlock& block = band.block[b];
  BlockValues room;
  const float* const value = active_values(block, room);
  int64_t left = n - before[b];
  for (int slot_of_point = 0; slot_of_point < 512; ++slot_of_point)
    if (block.active[slot_of_point >> 6] >> (slot_of_point & 63) & 1 && left-- == 0)
      return {block.corner + Vec3i{slot_of_point >> 6, slot_of_point >> 3 & 7, slot_of_point & 7},
              value[n - before[b]]};
  std::abort();
}

double worst_error(const Hierarchy& h, const density::Options& o, int points) {
  density::Counts counts;
  const Band band = density::compute(h, o, counts);
  std::vector<int64_t> before{0};
  for (const BandBlock& b : band.block) {
    int64_t active = 0;
    for (const uint64_t word : b.active)
      active += std::popcount(word);
    before.push_back(before.back() + active);
  }
  std::mt19937_64 random(1);
  std::uniform_int_distribution<int64_t> any(0, before.back() - 1);
  double worst = 0;
  for (int i = 0; i < points; ++i) {
    const Sample s = active_point(band, before, any(random));
    const double exact = test::exact_density(h, o.decay, band.frame.position(s.point));
    worst = std::max(worst, std::abs(s.value - exact) / (o.tolerance * std::max(1.0, exact)));
  }
  return worst;
}

} // namespace

int main(int count, char** arg) {
  if (count != 5) {
    std::fprintf(stderr, "field_errors FILE.hier SPACING TOLERANCE POINTS\n");
    return 2;
  }
  std::ifstream in(arg[1]);
  Hierarchy h = formats::read_hier(in, arg[1]);
  density::Options o;
  o.spacing = std::atof(arg[2]);
  o.tolerance = std::atof(arg[3]);
  const double setting[][2] = {{0.3, 1}, {0.5, 1}, {0.05, 0.5}, {0.02, 1}, {2, 0.5}, {0.2, 1.1}};
  for (const auto& [residue, chain] : setting) {
    for (Group& g : h.level.at(1).group)
      g.exponent = residue;
    for (Group& g : h.level.at(0).group)
      g.exponent = chain;
    std::printf("P_R %g, P_C %g: %.3f\n", residue, chain, worst_error(h, o, std::atoi(arg[4])));
    std::fflush(stdout);
  }
}
