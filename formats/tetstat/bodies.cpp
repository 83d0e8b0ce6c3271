// bodies.cpp — finds bodies and boundaries, measures and prints them.
#include "formats/tetstat/bodies.hpp"
#include "formats/tetstat/layout.hpp"
#include "formats/vtu/cell_labels.hpp"
#include "formats/vtu/names.hpp"
#include "mesh/surface.hpp"
#include <algorithm>
#include <nlohmann/json.hpp>

namespace molmesh::formats {
namespace {

/// What one piece of a region is called.
std::string kind(const BodyList& list, int32_t region) {
  const auto own = list.region_name.find(region);
  return own != list.region_name.end() ? plain(own->second)
         : region == Region::molecule  ? "body"
                                       : region_name(region);
}

std::string counted(int64_t n, const char* one, const char* more) {
  return grouped(n) + ' ' + (n == 1 ? one : more);
}

} // namespace

BodyList list_bodies(const TetMesh& m, const std::string& file, int threads) {
  const TriangleSides sides = triangle_sides(m, threads);
  const MeshBodies bodies = find_bodies(m, sides.across);
  BodyList list{file, false, bodies.body, {}, names_of(m, "region_names"), {}};
  const std::vector<CellLabel> labels = cell_labels(m);
  if (const PlaceNames places(labels); places.known())
    list.residues = names_round_bodies(m, sides, bodies, places);
  const std::vector<int32_t> label = patches(m);
  std::map<int32_t, BoundarySummary> boundary;
  for (const auto& [number, name] : boundary_names(m, label))
    boundary[number] = {number, name, 0, 0};
  for (size_t i = 0; i < m.tri.size(); ++i) {
    BoundarySummary& b = boundary[label[i]];
    ++b.triangles;
    b.area += tri_area(m.point[m.tri[i][0]], m.point[m.tri[i][1]], m.point[m.tri[i][2]]);
  }
  for (const auto& [number, b] : boundary)
    list.boundary.push_back(b);
  if (std::all_of(m.region.begin(), m.region.end(), [](int32_t r) { return r == Region::outside; })) {
    std::vector<Tri> surface;
    for (size_t i = 0; i < m.tri.size(); ++i)
      if (m.boundary[i] == Boundary::surface)
        surface.push_back(m.tri[i]);
    list.holes = summarize_surface(m.point, surface, threads).components;
  }
  return list;
}

std::string bodies_text(const BodyList& list) {
  int64_t bodies = 0, cavities = 0;
  for (const MeshBody& b : list.body)
    bodies += b.region == Region::molecule || b.region > Region::cavity, cavities += b.region == Region::cavity;
  std::string s = list.file + ": ";
  if (list.holes > 0)
    s += "the outside alone, with " + counted(list.holes, "hole", "holes") +
         " for the molecule; closed cavities are not in it: density2tet --region both has them listed";
  else if (s += counted(bodies, "body", "bodies"); bodies == static_cast<int64_t>(list.body.size()))
    s += "; cavities are holes in this mesh of the inside alone: density2tet --region both has them listed";
  else
    s += ", " + counted(cavities, "cavity", "cavities");
  if (list.uncrossed)
    s += "; no surface triangles cross";
  const bool round = !list.residues.empty();
  std::map<int32_t, int> number;
  std::vector<std::string> name;
  size_t width = 14;
  for (const MeshBody& b : list.body) {
    name.push_back(kind(list, b.region) + ' ' + std::to_string(++number[b.region]));
    width = std::max(width, columns(name.back()));
  }
  for (const BoundarySummary& b : list.boundary)
    width = std::max(width, columns(plain(b.name)));
  s += "\n\n" + padded("", width) +
       print(" %18s %15s %12s   centre/Å%s\n", "volume/Å³", "area/Å²", "tetrahedra",
             round ? "                residues round it" : "");
  for (size_t i = 0; i < list.body.size(); ++i) {
    const MeshBody& b = list.body[i];
    const std::string centre = print("%.2f %.2f %.2f", b.centre.x, b.centre.y, b.centre.z);
    s += padded(name[i], width) + print(" %16s %13s %12s   %s", amount(b.volume).c_str(), amount(b.area).c_str(),
                                        grouped(b.tets).c_str(), centre.c_str());
    if (round && !list.residues[i].empty()) {
      const std::vector<std::string>& names = list.residues[i];
      s += print("%*s%s", static_cast<int>(24 - std::min<size_t>(centre.size(), 23)), "",
                 plain(first_of(names)).c_str());
      if (names.size() > shown_names)
        s += " and " + grouped(static_cast<int64_t>(names.size() - shown_names)) + " more";
    }
    s += '\n';
  }
  s += '\n' + padded("boundary", width) + print(" %16s %15s %12s\n", "label", "area/Å²", "triangles");
  for (const BoundarySummary& b : list.boundary)
    s += padded(plain(b.name), width) +
         print(" %16d %13s %12s\n", b.label, amount(b.area).c_str(), grouped(b.triangles).c_str());
  return s;
}

std::string bodies_json(const BodyList& list) {
  using json = nlohmann::ordered_json;
  json j = {{"tetstat_bodies", 1},
            {"file", list.file},
            {"units", {{"volume", "Å³"}, {"area", "Å²"}, {"centre", "Å"}}},
            {"bodies", json::array()},
            {"boundaries", json::array()}};
  if (list.uncrossed)
    j["crossing_triangles"] = 0;
  for (size_t i = 0; i < list.body.size(); ++i) {
    const MeshBody& b = list.body[i];
    j["bodies"].push_back({{"region", b.region},
                           {"name", kind(list, b.region)},
                           {"tets", b.tets},
                           {"volume", b.volume},
                           {"area", b.area},
                           {"centre", {b.centre.x, b.centre.y, b.centre.z}}});
    if (!list.residues.empty())
      j["bodies"].back()["residues"] = list.residues[i];
  }
  for (const BoundarySummary& b : list.boundary)
    j["boundaries"].push_back({{"label", b.label}, {"name", b.name}, {"triangles", b.triangles}, {"area", b.area}});
  return j.dump(2, ' ', false, json::error_handler_t::replace) + '\n';
}

} // namespace molmesh::formats
