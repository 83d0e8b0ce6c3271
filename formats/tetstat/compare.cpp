// compare.cpp — two reports side by side.
#include "formats/tetstat/layout.hpp"
#include "formats/tetstat/tetstat.hpp"
#include <algorithm>
#include <cmath>
#include <set>

namespace molmesh::formats {
namespace {

const RegionSummary* find(const MeshReport& r, int32_t region) {
  const auto& all = r.validity.region; // ascending
  const auto at = std::lower_bound(all.begin(), all.end(), region,
                                   [](const RegionSummary& s, int32_t number) { return s.region < number; });
  return at != all.end() && at->region == region ? &*at : nullptr;
}

/// b / a - 1, or NaN.
double growth(double a, double b) {
  return a != 0 ? b / a - 1 : std::nan("");
}

std::string row(const char* name, const std::string& a, const std::string& b, const std::string& change = "") {
  std::string s = "  " + padded(name, 24) + print(" %16s %16s %14s", a.c_str(), b.c_str(), change.c_str());
  s.resize(s.find_last_not_of(' ') + 1);
  return s += '\n';
}
std::string count_row(const char* name, int64_t a, int64_t b) {
  return row(name, grouped(a), grouped(b), a == b ? "" : (b > a ? "+" : "") + grouped(b - a));
}
std::string amount_row(const char* name, double a, double b) {
  const double percent = 100 * growth(a, b);
  return row(name, amount(a), amount(b), a == b || std::isnan(percent) ? "" : print("%+.3f %%", percent));
}
std::string value_row(const char* name, double a, double b, int digits) {
  return row(name, print("%.*f", digits, a), print("%.*f", digits, b), a == b ? "" : print("%+.*f", digits, b - a));
}
std::string surface_rows(const SurfaceSummary& a, const SurfaceSummary& b) {
  return count_row("  triangles", a.triangles, b.triangles) + amount_row("  area/Å²", a.area, b.area) +
         count_row("  pieces", a.components, b.components) + count_row("  Euler number", a.euler, b.euler);
}
std::string measure_rows(const char* name, const Distribution& a, const Distribution& b, int digits) {
  return row(name, "", "") + value_row("  min", a.min, b.min, digits) +
         value_row("  mean", a.mean, b.mean, digits) + value_row("  max", a.max, b.max, digits);
}

std::string angle_rows(const Distribution& a, const Distribution& b) {
  std::string s;
  for (size_t i = 0; i + 1 < a.bin.size(); i += 2) {
    const int64_t before = a.bin[i] + a.bin[i + 1], after = b.bin[i] + b.bin[i + 1];
    if (before > 0 || after > 0)
      s += count_row(print("  %3zu to %3zu degrees", 5 * i, 5 * i + 10).c_str(), before, after);
  }
  return s;
}

} // namespace

std::string compare_text(const MeshReport& a, const MeshReport& b) {
  std::string s = "A  " + a.file + (a.creator.empty() ? "" : ", made by " + plain(a.creator)) + "\nB  " + b.file +
                  (b.creator.empty() ? "" : ", made by " + plain(b.creator)) + "\n\n";
  s += row("", "A", "B", "change");
  s += row("valid", a.validity.valid() ? "yes" : "NO", b.validity.valid() ? "yes" : "NO");
  for (const auto& [r, name] : {std::pair{&a, "A"}, std::pair{&b, "B"}})
    for (const Fault& f : r->validity.faults)
      s += print("    %s: %s %s   ", name, f.rule.c_str(), grouped(f.count).c_str()) + f.example + '\n';
  s += count_row("points", a.points, b.points) + count_row("tetrahedra", a.tets, b.tets) +
       count_row("triangles", a.triangles, b.triangles);
  if (!a.quality || !b.quality)
    return s;
  s += amount_row("volume/Å³", a.validity.volume, b.validity.volume);
  std::set<int32_t> regions;
  for (const MeshReport* r : {&a, &b})
    for (const RegionSummary& region : r->validity.region)
      regions.insert(region.region);
  for (int32_t region : regions) {
    const RegionSummary none, *before = find(a, region), *after = find(b, region);
    const RegionSummary &x = before ? *before : none, &y = after ? *after : none;
    s += print("  region %d\n", region) + count_row("  tetrahedra", x.tets, y.tets) +
         amount_row("  volume/Å³", x.volume, y.volume) + surface_rows(x.boundary, y.boundary);
  }
  s += "  surface\n" + amount_row("  volume/Å³", a.validity.surface.volume, b.validity.surface.volume) +
       surface_rows(a.validity.surface, b.validity.surface);
  const Quality &p = a.quality->all, &q = b.quality->all;
  s += '\n' + measure_rows("dihedral (degrees)", p.dihedral, q.dihedral, 2) +
       measure_rows("Joe-Liu Q (eq. 8)", p.joe_liu_q, q.joe_liu_q, 4) +
       measure_rows("Joe-Liu eta", p.eta, q.eta, 4) + measure_rows("edge ratio", p.edge_ratio, q.edge_ratio, 3);
  s += "\n  dihedral angles\n" + angle_rows(p.dihedral, q.dihedral);
  if (b.asked.min > 0 || b.asked.max < 180)
    s += '\n' + count_row(print("outside %g to %g", b.asked.min, b.asked.max).c_str(), p.outside, q.outside);
  return s;
}

} // namespace molmesh::formats
