// colouring.cpp — gives every triangle the colour of its label, and the colours a legend.
#include "formats/html/colouring.hpp"
#include "base/error.hpp"
#include "formats/vtu/names.hpp"
#include "mesh/region_order.hpp"
#include "picture/colours.hpp"
#include <algorithm>
#include <map>

namespace molmesh::formats {

std::map<int32_t, std::string> user_boundaries(const TetMesh& m) {
  const std::vector<int32_t> patch = patches(m);
  std::map<int32_t, std::string> named = names_of(m, "patch_names");
  std::erase_if(named, [&](const auto& n) {
    return is_own_name(n.second) || std::find(patch.begin(), patch.end(), n.first) == patch.end();
  });
  return named;
}

std::string usual_colour(const TetMesh& m, const std::vector<CellLabel>& labels) {
  if (!user_boundaries(m).empty())
    return "boundary";
  const CellLabel* const chain = find_label(labels, "chain");
  if (chain && chain->names.size() > 1)
    return "chain";
  if (RegionOrder(m).last_domain > Region::cavity)
    return "region";
  const CellLabel& boundary = *find_label(labels, "boundary");
  for (const std::string& n : boundary.names)
    if (!is_own_name(n))
      return "boundary";
  return std::any_of(m.region.begin(), m.region.end(), [&](int32_t r) { return r != m.region[0]; }) ? "region"
                                                                                                    : "plain";
}

picture::Colouring colouring_by(const std::string& name, const TetMesh& m, const TriangleSides& sides,
                                const MeshBodies& bodies, const std::vector<CellLabel>& labels) {
  picture::Colouring c{name, {}, {}, {}};
  if (name == "plain")
    return {};
  const CellLabel* const label = find_label(labels, name);
  if (!label && name != "region" && name != "body") {
    std::string known = "plain, region, body";
    for (const CellLabel& l : labels)
      known += ", " + l.name;
    fail(Status::usage, "found the colour '" + name + "', expected one of " + known, {"colour"});
  }
  const RegionOrder order(m);
  std::map<int32_t, bool> used;
  for (size_t i = 0; i < m.tri.size(); ++i) {
    int32_t value = -1;
    const auto tet = [&](size_t side) { return sides.face[i][side] / 4; };
    if (label && !label->tri.empty())
      value = label->tri[i];
    else if (sides.face[i][0] >= 0) {
      // The side that the surface is that of.
      const bool second = sides.face[i][1] >= 0 && order.is_first(m.region[tet(1)], m.region[tet(0)]);
      const int32_t t = tet(second ? 1 : 0);
      value = label ? label->tet[t] : name == "region" ? m.region[t] - 1 : bodies.of[t];
    }
    if (value >= 0 || m.boundary[i] < Boundary::box_x0 || m.boundary[i] > Boundary::box_z1)
      used[value] = true; // walls have no structure behind them, and no row for that
    c.triangle.push_back(picture::label_colour(value));
  }
  const std::map<int32_t, std::string> regions = region_names(m);
  if (name == "region")
    for (const auto& [region, text] : regions)
      c.region[region] = picture::label_colour(region - 1);
  std::vector<std::string> body_name; // "body 2", "cavity 1", counted in each region
  std::map<int32_t, int> pieces;
  for (const MeshBody& b : bodies.body)
    body_name.push_back((b.region == Region::molecule ? "body" : regions.at(b.region)) + ' ' +
                        std::to_string(++pieces[b.region]));
  for (const auto& [value, seen] : used) {
    const std::string text = value < 0          ? "none"
                             : label            ? label->names[value]
                             : name == "region" ? regions.at(value + 1)
                                                : body_name[value];
    c.legend.push_back({text, picture::label_colour(value)});
  }
  return c;
}

} // namespace molmesh::formats
