// facts.cpp — measures the mesh and puts the figures into JSON.
#include "formats/html/facts.hpp"
#include "formats/vtu/names.hpp"
#include "geom/tet_quality.hpp"
#include "mesh/region_order.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

namespace molmesh::formats {
namespace {

using json = nlohmann::ordered_json;

json finite(double v) {
  return std::isfinite(v) ? json(v) : json(nullptr);
}
json numbers(Vec3d p) {
  return {p.x, p.y, p.z};
}

json distribution(const Distribution& d) {
  return {{"min", finite(d.min)}, {"max", finite(d.max)}, {"mean", finite(d.mean)},
          {"low", d.low},         {"width", d.width},     {"bins", d.bin}};
}

/// Range over the elements of an element's smallest and of its largest dihedral angle.
struct Extremes {
  double least[2] = {180, 0}, most[2] = {180, 0};
};
Extremes extremes(const TetMesh& m, int threads) {
  return par::reduce(
      static_cast<int64_t>(m.tet.size()), threads, Extremes{},
      [&](int64_t t) {
        const auto p = [&](size_t i) { return m.point[m.tet[t][i]]; };
        const DihedralTrig d = dihedral_trig(p(0), p(1), p(2), p(3));
        double low = 1, high = -1; // cosines
        for (const double c : d.cosine)
          if (c == c)
            low = std::min(low, c), high = std::max(high, c);
        const auto degrees = [](double c) {
          return std::acos(std::clamp(c, -1., 1.)) * (180 / 3.14159265358979323846);
        };
        const double a = degrees(high), b = degrees(low);
        return Extremes{{a, a}, {b, b}};
      },
      [](Extremes a, const Extremes& b) {
        a.least[0] = std::min(a.least[0], b.least[0]), a.least[1] = std::max(a.least[1], b.least[1]);
        a.most[0] = std::min(a.most[0], b.most[0]), a.most[1] = std::max(a.most[1], b.most[1]);
        return a;
      });
}

} // namespace

std::vector<int64_t> worst_by_quality(const TetMesh& m, size_t most, int threads) {
  const auto tets = static_cast<int64_t>(m.tet.size());
  LargeArray<float> quality(m.tet.size());
  par::for_n(tets, threads, [&](int64_t t) {
    const auto p = [&](size_t i) { return m.point[m.tet[t][i]]; };
    const float q = tet_quality(p(0), p(1), p(2), p(3));
    quality[t] = q == q ? q : -1;
  });
  std::vector<int64_t> worst(static_cast<size_t>(tets));
  std::iota(worst.begin(), worst.end(), 0);
  const size_t kept = std::min(most, worst.size());
  std::partial_sort(
      worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(kept), worst.end(),
      [&](int64_t a, int64_t b) { return quality[a] != quality[b] ? quality[a] < quality[b] : a < b; });
  worst.resize(kept);
  return worst;
}

std::string facts_json(const TetMesh& m, const TriangleSides& sides, const MeshBodies& bodies,
                       const std::vector<CellLabel>& labels, const ReportedMesh& more,
                       const std::vector<int64_t>& worst, const LargeArray<int32_t>& place, int threads) {
  const PlaceNames places(labels);
  json j;
  j["name"] = more.name;
  j["file"] = more.file;
  j["source"] = m.source;
  j["creator"] = m.creator;
  j["isovalue"] = m.isovalue;
  j["decay"] = m.decay;
  j["points"] = m.point.size();
  j["tets"] = m.tet.size();
  j["triangles"] = m.tri.size();
  Vec3d low = m.point[0], high = low;
  for (const Vec3d& p : m.point)
    for (int axis = 0; axis < 3; ++axis)
      low[axis] = std::min(low[axis], p[axis]), high[axis] = std::max(high[axis], p[axis]);
  j["low"] = numbers(low);
  j["high"] = numbers(high);
  j["colour"] = more.colour;
  j["notes"] = more.notes;
  j["valid"] = more.validity ? json(more.validity->valid()) : json(nullptr);
  j["faults"] = json::array();
  if (more.validity)
    for (const Fault& f : more.validity->faults)
      j["faults"].push_back({{"rule", f.rule}, {"count", f.count}, {"example", f.example}});

  const std::vector<std::vector<std::string>> residues = names_round_bodies(m, sides, bodies, places);
  const RegionOrder order(m);
  j["bodies"] = json::array();
  for (size_t b = 0; b < bodies.body.size(); ++b) {
    const MeshBody& body = bodies.body[b];
    j["bodies"].push_back({{"region", body.region},
                           {"molecular", order.is_inside(body.region)},
                           {"tets", body.tets},
                           {"volume", body.volume},
                           {"area", body.area},
                           {"centre", numbers(body.centre)},
                           {"low", numbers(body.low)},
                           {"high", numbers(body.high)},
                           {"residues", first_of(residues[b])},
                           {"residues_named", std::min(shown_names, residues[b].size())},
                           {"residue_count", residues[b].size()}});
  }
  // In the order in which a surface between two of them is that of the first.
  std::vector<std::pair<int32_t, std::string>> regions;
  for (const auto& r : region_names(m))
    regions.push_back(r);
  std::sort(regions.begin(), regions.end(),
            [&](const auto& a, const auto& b) { return order.is_first(a.first, b.first); });
  j["regions"] = json::array();
  for (const auto& [region, name] : regions)
    j["regions"].push_back({{"region", region}, {"name", name}});
  const CellLabel& boundary = *find_label(labels, "boundary");
  std::vector<double> area(boundary.names.size());
  std::vector<int64_t> triangles(boundary.names.size());
  double surface = 0; // of the molecule: neither walls nor interfaces between its domains
  for (size_t i = 0; i < m.tri.size(); ++i) {
    const double a = tri_area(m.point[m.tri[i][0]], m.point[m.tri[i][1]], m.point[m.tri[i][2]]);
    area[boundary.tri[i]] += a;
    ++triangles[boundary.tri[i]];
    const std::string& name = boundary.names[boundary.tri[i]];
    const bool wall = name.starts_with("box_") || name == "sphere";
    const auto is_inside = [&](int32_t face) { return face >= 0 && order.is_inside(m.region[face / 4]); };
    if (!wall && !(is_inside(sides.face[i][0]) && is_inside(sides.face[i][1])))
      surface += a;
  }
  j["surface"] = surface;
  j["boundaries"] = json::array();
  for (size_t b = 0; b < area.size(); ++b)
    j["boundaries"].push_back({{"name", boundary.names[b]}, {"triangles", triangles[b]}, {"area", area[b]}});

  const Quality q = measure_quality(m, threads).all;
  const Extremes e = extremes(m, threads);
  j["quality"] = {{"dihedral", distribution(q.dihedral)},
                  {"joe_liu_q", distribution(q.joe_liu_q)},
                  {"edge_ratio", distribution(q.edge_ratio)},
                  {"smallest", e.least},
                  {"largest", e.most}};
  j["worst"] = json::array();
  for (const int64_t t : worst) {
    const auto p = [&](size_t i) { return m.point[m.tet[t][i]]; };
    const Dihedrals d = dihedrals(p(0), p(1), p(2), p(3));
    j["worst"].push_back(
        {{"tet", t},
         {"place", place.empty() ? -1 : place[t]},
         {"min", finite(*std::min_element(d.degree, d.degree + 6))},
         {"max", finite(*std::max_element(d.degree, d.degree + 6))},
         {"q", finite(joe_liu_q(six_volume(p(0), p(1), p(2), p(3)), edge_sum2(p(0), p(1), p(2), p(3))))},
         {"region", m.region[t]},
         {"centre", numbers(cell_centroid(m, static_cast<size_t>(t)))},
         {"residue", places.of_tet(m, t)}});
  }
  j["runs"] = json::array();
  for (const std::string& r : more.run_report)
    j["runs"].push_back(json::parse(r));
  std::string text = j.dump(-1, ' ', false, json::error_handler_t::replace);
  text.pop_back();
  return text;
}

} // namespace molmesh::formats
