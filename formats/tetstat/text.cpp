// text.cpp — the report on one screen.
#include "formats/tetstat/layout.hpp"
#include "formats/tetstat/tetstat.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::formats {
namespace {

std::string name_in(const std::map<int32_t, std::string>& names, int32_t number) {
  const auto at = names.find(number);
  return at == names.end() ? "" : plain(at->second);
}

std::string region_name(const MeshReport& r, int32_t region) {
  return region == Region::molecule  ? "molecule"
         : region == Region::outside ? "outside"
         : region == Region::cavity  ? "cavity"
                                     : name_in(r.region_name, region);
}

std::string label_name(const MeshReport& r, int32_t label) {
  if (r.sphere && label == Boundary::outer_sphere)
    return "sphere";
  static const char* names[] = {"", "surface", "-x", "+x", "-y", "+y", "-z", "+z"};
  return label >= 1 && label <= 7 ? names[label] : name_in(r.label_name, label);
}

std::string measure(const char* name, const Distribution& d, int digits) {
  std::string s = print("  %-18s", name);
  for (double v : {d.min, d.mean, d.max})
    s += print("%12.*f", digits, v);
  return s + print("   tets %lld, %lld\n", static_cast<long long>(d.min_tet), static_cast<long long>(d.max_tet));
}

std::string angle_histogram(const Distribution& d) {
  int64_t total = 0, most = 1;
  size_t first = d.bin.size(), last = 0;
  std::vector<int64_t> wide; // bins of 10°
  for (size_t i = 0; i < d.bin.size() / 2; ++i) {
    wide.push_back(d.bin[2 * i] + d.bin[2 * i + 1]);
    total += wide[i];
    most = std::max(most, wide[i]);
    if (wide[i] > 0) {
      first = std::min(first, i);
      last = i;
    }
  }
  std::string s;
  if (d.min < 0)
    s += "  (angles of inverted tetrahedra, below 0°, are counted in the first row)\n";
  for (size_t i = first; i <= last; ++i) {
    const double share = double(wide[i]) / double(std::max<int64_t>(total, 1));
    s += print("  %3zu° to %3zu° %14s %8.3f %%", 10 * i, 10 * i + 10, grouped(wide[i]).c_str(), 100 * share);
    if (wide[i] > 0)
      s += "  " + std::string(static_cast<size_t>(std::ceil(40.0 * double(wide[i]) / double(most))), '#');
    s += '\n';
  }
  return s;
}

std::string regions_table(const MeshReport& r) {
  size_t width = 9; // of names
  for (const RegionSummary& region : r.validity.region)
    width = std::max(width, columns(region_name(r, region.region)));
  std::string s =
      padded("region", width + 15) + "tets         volume/Å³        area/Å²  pieces   Euler   dihedral angles\n";
  for (size_t i = 0; i < r.validity.region.size(); ++i) {
    const RegionSummary& region = r.validity.region[i];
    const SurfaceSummary& b = region.boundary;
    const Distribution& angle = r.quality->of[i].dihedral;
    s += print("  %-3d ", region.region) + padded(region_name(r, region.region), width) +
         print(" %12s %17s %14s %7lld %7lld   %6.2f° to %6.2f°\n", grouped(region.tets).c_str(),
               amount(region.volume).c_str(), amount(b.area).c_str(), static_cast<long long>(b.components),
               static_cast<long long>(b.euler), angle.min, angle.max);
  }
  const auto add_boundary = [&](const char* name, const SurfaceSummary& b) {
    if (b.triangles > 0)
      s += "  " + padded(name, width - 2) +
           print(" %9s triangles %16s %14s %7lld %7lld\n", grouped(b.triangles).c_str(), amount(b.volume).c_str(),
                 amount(b.area).c_str(), static_cast<long long>(b.components), static_cast<long long>(b.euler));
  };
  add_boundary("surface", r.validity.surface);
  if (r.validity.outer_sphere)
    add_boundary("sphere", *r.validity.outer_sphere);
  return s;
}

} // namespace

std::string tetstat_text(const MeshReport& r) {
  const Validity& v = r.validity;
  std::string s = r.file;
  if (!r.creator.empty())
    s += ", made by " + plain(r.creator);
  if (!r.source.empty())
    s += ", from " + plain(r.source);
  s += v.valid() ? "\nvalid\n" : "\nINVALID\n";
  for (const Fault& f : v.faults)
    s += print("  %-20s %12s   ", f.rule.c_str(), grouped(f.count).c_str()) + f.example + '\n';
  if (r.uncrossed)
    s += "  no surface triangles cross\n";
  s += grouped(r.points) + " points, " + grouped(r.tets) + " tetrahedra, " + grouped(r.triangles) + " triangles";
  if (r.parts > 0)
    s += ", " + grouped(r.parts) + " parts";
  s += "\ntriangles by label:";
  for (const auto& [label, count] : r.labels)
    s += print("  %lld %s ", static_cast<long long>(label), label_name(r, int32_t(label)).c_str()) + grouped(count);
  s += '\n';
  if (!r.quality)
    return s;
  s +=
      print("box  %.3f %.3f %.3f  to  %.3f %.3f %.3f Å\n", v.low.x, v.low.y, v.low.z, v.high.x, v.high.y, v.high.z);
  if (r.sphere)
    s += print("outer sphere  %.3f Å about  %.3f %.3f %.3f Å\n", r.sphere->radius, r.sphere->center.x,
               r.sphere->center.y, r.sphere->center.z);
  const Quality& q = r.quality->all;
  s += '\n' + regions_table(r);
  s += "\nquality                      min        mean         max   where\n";
  s += measure("dihedral (degrees)", q.dihedral, 2);
  s += measure("Joe-Liu Q (eq. 8)", q.joe_liu_q, 4);
  s += measure("Joe-Liu eta", q.eta, 4);
  s += measure("edge ratio", q.edge_ratio, 3);
  s += "\ndihedral angles\n" + angle_histogram(q.dihedral);
  const AngleLimits any;
  if (!r.good() && (r.asked.min > any.min || r.asked.max < any.max))
    s += print("\nBELOW THE QUALITY ASKED FOR: %s tetrahedra with angles outside %g° to %g°\n",
               grouped(q.outside).c_str(), r.asked.min, r.asked.max);
  return s;
}

} // namespace molmesh::formats
