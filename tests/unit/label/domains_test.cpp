// domains_test.cpp — three bodies as domains: from the density to an improved mesh, interfaces where shares are
// equal.
#include "contour/contour.hpp"
#include "label/divide.hpp"
#include "label/equal_shares.hpp"
#include "mesh/region_order.hpp"
#include "mesh/validity.hpp"
#include "optimize/optimize.hpp"
#include "unit/contour/sample_grid.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>

using namespace molmesh;

namespace {

/// Three balls that overlap, each a domain: they meet in a line, which ends on the surface.
struct Bodies {
  std::vector<Vec3d> center{{-1.6, 0, 0.1}, {1.7, 0.2, 0}, {0.1, 2.9, 0.2}};
  double radius = 2.6, decay = 0.5;

  Hierarchy hierarchy() const {
    Hierarchy h;
    h.level.push_back({"domain", {}});
    for (const Vec3d& c : center) {
      const auto n = static_cast<int64_t>(h.atom.size());
      h.level[0].group.push_back({std::string(1, char('a' + n)), 1, n, n + 1});
      h.atom.push_back({c, radius});
    }
    return h;
  }
  double field(Vec3d p) const {
    double sum = 0;
    for (const Vec3d& c : center)
      sum += std::exp(decay * (radius * radius - norm2(p - c)));
    return sum;
  }
};

TetMesh divided_mesh(const BlockGrid& grid, const label::ShareFinder& shares, contour::Options::Meshed meshed,
                     int threads) {
  contour::Options options;
  options.meshed = meshed;
  options.threads = threads;
  options.owners = [&](const std::vector<Vec3d>& place) {
    std::vector<contour::Owner> all;
    for (const label::Shares& s : shares.at(place))
      all.push_back({s.owner(), s.lead()});
    return all;
  };
  contour::Summary summary;
  TetMesh m = contour::contour(grid, options, summary, [](const std::string&) {});
  label::divide(m, shares, threads);
  m.named_text.push_back({region_level_text, "domain"});
  m.named_text.push_back({region_names_text, "4 a\n5 b\n6 c\n"});
  return m;
}

void require_valid(const TetMesh& m) {
  Validity v = check_validity(m, 2);
  add_crossings(v, m, 2);
  for (const Fault& f : v.faults)
    UNSCOPED_INFO(f.rule << " " << f.count << " " << f.example);
  REQUIRE(v.valid());
}

} // namespace

TEST_CASE("Three domains stay manifolds when their mesh is improved, and meet where their shares are equal",
          "[slow]") {
  const Bodies bodies;
  const double h = 0.5;
  const BlockGrid grid =
      test::sample_grid({-14, -12, -12}, {29, 32, 25}, h, 10, [&](Vec3d p) { return bodies.field(p); });
  const label::ShareFinder shares(bodies.hierarchy(), 0, {bodies.decay, 1, 2});
  for (const auto meshed : {contour::Options::both, contour::Options::interior}) {
    TetMesh m = divided_mesh(grid, shares, meshed, 2);
    require_valid(m);
    for (size_t t = 0; t < m.tri.size(); ++t) // cells between owners are the smallest
      for (size_t i = 0; i < 3 && m.boundary[t] > Boundary::box_z1; ++i)
        CHECK(norm(m.point[m.tri[t][i]] - m.point[m.tri[t][(i + 1) % 3]]) < 1.8 * h);
    const TetMesh same = divided_mesh(grid, shares, meshed, 1);
    CHECK(same.point == m.point);
    CHECK(same.tri == m.tri);
    optimize::Options options;
    options.threads = 2;
    for (const auto& [l, i] : label::interfaces_of(m))
      options.interfaces[l] = std::make_shared<label::EqualShares>(shares, i, grid.frame, 2);
    REQUIRE(options.interfaces.size() == 3);
    const auto texts = m.named_text;
    const optimize::Result result = optimize::improve(m, &grid, options);
    m.named_text = texts; // which improve() leaves to its caller
    CHECK_FALSE(result.rejected);
    require_valid(m);
    CHECK(result.after.min > 25);
    CHECK(result.after.max < 140);
    CHECK(result.fidelity.points_off == 0);
    CHECK(result.fidelity.interface_points > 100);
    CHECK(result.fidelity.interface_points_off == 0);
    std::vector<Vec3d> on_interface;
    std::vector<std::array<int32_t, 2>> pair;
    for (const auto& [l, i] : label::interfaces_of(m))
      for (const Vec3d& p : i.point) {
        on_interface.push_back(p);
        pair.push_back(i.group);
      }
    const auto at = shares.at(on_interface);
    // Distances from equal shares: |ln a/b| over its gradient, 2 κ |a - b|. A point of the line where all three
    // meet stays on two interfaces; what it is off the third then follows.
    std::map<std::array<double, 3>, std::vector<double>> off;
    for (size_t i = 0; i < at.size(); ++i)
      off[{on_interface[i].x, on_interface[i].y, on_interface[i].z}].push_back(
          std::abs(at[i].ln_of(pair[i][0]) - at[i].ln_of(pair[i][1])) /
          (2 * bodies.decay * norm(bodies.center[pair[i][0]] - bodies.center[pair[i][1]])));
    double worst = 0;
    for (auto& [place, distance] : off) {
      std::sort(distance.begin(), distance.end());
      worst = std::max(worst, distance[std::min<size_t>(distance.size() - 1, 1)]);
    }
    CHECK(worst < 0.0205 * h); // ln of the ratio is linear here
  }
}
