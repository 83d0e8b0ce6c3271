// report.cpp — counts, and the JSON form.
#include "formats/tetstat/tetstat.hpp"
#include "formats/vtu/names.hpp"
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace molmesh::formats {
namespace {

using json = nlohmann::ordered_json;

json finite(double v) {
  return std::isfinite(v) ? json(v) : json(nullptr);
}

json surface_json(const SurfaceSummary& s) {
  return {{"triangles", s.triangles}, {"edges", s.edges}, {"points", s.points},        {"components", s.components},
          {"euler", s.euler},         {"area", s.area},   {"volume", finite(s.volume)}};
}

json distribution_json(const Distribution& d) {
  return {{"min", finite(d.min)},   {"max", finite(d.max)},
          {"mean", finite(d.mean)}, {"min_tet", d.min_tet},
          {"max_tet", d.max_tet},   {"histogram", {{"low", d.low}, {"width", d.width}, {"counts", d.bin}}}};
}

json quality_json(const Quality& q) {
  return {{"dihedral", distribution_json(q.dihedral)},
          {"joe_liu_q", distribution_json(q.joe_liu_q)},
          {"joe_liu_eta", distribution_json(q.eta)},
          {"edge_ratio", distribution_json(q.edge_ratio)},
          {"outside", q.outside}};
}

/// place: stands for the regions, which with_regions() puts there.
json mesh_json(const MeshReport& r, const char* place) {
  const Validity& v = r.validity;
  json j;
  j["tetstat"] = 1;
  j["file"] = r.file;
  j["source"] = r.source;
  j["creator"] = r.creator;
  j["isovalue"] = r.isovalue;
  j["valid"] = v.valid();
  j["faults"] = json::array();
  for (const Fault& f : v.faults)
    j["faults"].push_back({{"rule", f.rule}, {"count", f.count}, {"example", f.example}});
  j["asked"] = {{"min_dihedral", r.asked.min}, {"max_dihedral", r.asked.max}, {"met", r.good()}};
  j["points"] = r.points;
  j["tets"] = r.tets;
  j["triangles"] = r.triangles;
  j["labels"] = json::array();
  for (const auto& [label, count] : r.labels) {
    j["labels"].push_back({{"boundary", label}, {"triangles", count}});
    if (const auto name = r.label_name.find(static_cast<int32_t>(label)); name != r.label_name.end())
      j["labels"].back()["name"] = name->second;
  }
  j["parts"] = r.parts;
  j["dropped_cells"] = r.notes.dropped_cells;
  j["dropped_triangles"] = r.notes.dropped_triangles;
  if (!r.quality)
    return j;
  j["box"] = {{"low", {v.low.x, v.low.y, v.low.z}}, {"high", {v.high.x, v.high.y, v.high.z}}};
  j["volume"] = v.volume;
  j["surface"] = surface_json(v.surface);
  if (r.sphere && v.outer_sphere) {
    j["outer_sphere"] = surface_json(*v.outer_sphere);
    j["outer_sphere"]["center"] = {r.sphere->center.x, r.sphere->center.y, r.sphere->center.z};
    j["outer_sphere"]["radius"] = r.sphere->radius;
  }
  j["quality"] = quality_json(r.quality->all);
  j["regions"] = place;
  return j;
}

std::string text_of(const json& j) {
  return j.dump(2, ' ', false, json::error_handler_t::replace);
}

/// One after the other: a tree of 100,000 regions would take gigabytes. indent: of the list's end.
std::string with_regions(const std::string& text, const MeshReport& r, const char* place, size_t indent) {
  const std::string key = "\"regions\": ", mark = key + '"' + place + '"';
  const size_t at = text.find(mark);
  if (at == std::string::npos)
    return text;
  std::string list = text.substr(0, at) + key + '[';
  const Validity& v = r.validity;
  const std::string line = '\n' + std::string(indent + 2, ' ');
  for (size_t i = 0; i < v.region.size(); ++i) {
    const RegionSummary& region = v.region[i];
    json entry = {{"region", region.region},
                  {"tets", region.tets},
                  {"volume", region.volume},
                  {"boundary", surface_json(region.boundary)},
                  {"quality", quality_json(r.quality->of[i])}};
    if (const auto name = r.region_name.find(region.region); name != r.region_name.end())
      entry["name"] = name->second;
    const std::string one = text_of(entry);
    list += i > 0 ? "," + line : line;
    for (const char c : one)
      c == '\n' ? list += line : list += c;
  }
  return list + '\n' + std::string(indent, ' ') + ']' + text.substr(at + mark.size());
}

} // namespace

MeshReport report_mesh(const TetMesh& m, const std::string& file, const MeshNotes& notes, Validity validity,
                       AngleLimits asked, int threads) {
  MeshReport r;
  r.file = file;
  r.source = m.source;
  r.creator = m.creator;
  r.isovalue = m.isovalue;
  r.sphere = m.sphere;
  r.points = static_cast<int64_t>(m.point.size());
  r.tets = static_cast<int64_t>(m.tet.size());
  r.triangles = static_cast<int64_t>(m.tri.size());
  std::map<int32_t, int64_t> labels;
  for (int32_t b : m.boundary)
    ++labels[b];
  for (const auto& [label, count] : labels)
    r.labels.push_back({label, count});
  r.parts = static_cast<int64_t>(std::set<int32_t>(m.part.begin(), m.part.end()).size());
  r.notes = notes;
  r.validity = std::move(validity);
  for (const auto& [region, name] : names_of(m, "region_names"))
    if (region > Region::cavity)
      r.region_name[region] = name;
  const std::map<int32_t, std::string> named = names_of(m, "boundary_names");
  for (const auto& [label, count] : labels)
    if (const auto name = named.find(label); name != named.end() && label > Boundary::box_z1)
      r.label_name[label] = name->second;
  if (!r.validity.region.empty())
    r.quality = measure_quality(m, threads, asked);
  r.asked = asked;
  return r;
}

std::string tetstat_json(const MeshReport& r) {
  return with_regions(text_of(mesh_json(r, "@")), r, "@", 2) + '\n';
}

std::string compare_json(const MeshReport& a, const MeshReport& b) {
  json j;
  j["tetstat_compare"] = 1;
  j["a"] = mesh_json(a, "@a");
  j["b"] = mesh_json(b, "@b");
  return with_regions(with_regions(text_of(j), a, "@a", 4), b, "@b", 4) + '\n';
}

} // namespace molmesh::formats
