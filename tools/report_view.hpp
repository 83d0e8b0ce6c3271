// report_view.hpp — what of a mesh tetreport's picture shows, and from where.
#pragma once
#include "cli/run.hpp"
#include "formats/html/colouring.hpp"
#include "formats/vtu/names.hpp"
#include "picture/mesh_picture.hpp"
#include "tools/options/tetreport.hpp"
#include <algorithm>
#include <cmath>
#include <set>

namespace molmesh {

inline std::vector<int32_t> shown_regions(const Options& o, const TetMesh& m) {
  const std::set<int32_t> all(m.region.begin(), m.region.end());
  std::vector<int32_t> shown;
  for (const int32_t r : all) {
    const bool around = r == Region::outside;
    if (o.region == "both" || (o.region == "exterior") == around)
      shown.push_back(r);
  }
  if (shown.empty() && o.region != "auto")
    fail(Status::usage, "--region: found " + o.region + ", of which the mesh has nothing");
  return shown.empty() ? std::vector<int32_t>(all.begin(), all.end()) : shown;
}

/// [triangles] 1: of this boundary.
inline std::vector<uint8_t> marked(const TetMesh& m, int32_t label) {
  std::vector<uint8_t> mark;
  for (const int32_t l : formats::patches(m))
    mark.push_back(l == label);
  return mark;
}

/// named: boundaries that the surface is coloured by. They are shown whole, and one alone from where most of it is
/// seen, where the outside does not hide them.
inline picture::View view_of(const Options& o, const TetMesh& m, const std::map<int32_t, std::string>& named,
                             const std::vector<int32_t>& region, int threads) {
  picture::View v;
  if (named.size() == 1 && !o.azimuth && !o.elevation && !std::count(region.begin(), region.end(), Region::outside))
    v = picture::best_view(m, marked(m, named.begin()->first), threads).view;
  return {o.azimuth.value_or(v.azimuth), o.elevation.value_or(v.elevation)};
}
inline std::string cut_axes(const Options& o, const std::map<int32_t, std::string>& named,
                            const std::vector<int32_t>& region) {
  const bool whole = !named.empty() && !o.clip_at && !std::count(region.begin(), region.end(), Region::outside);
  const std::string clip = o.clip != "auto" ? o.clip : whole ? "none" : "corner";
  return clip == "corner" ? "xy" : clip == "none" ? "" : clip;
}

/// One note for each named boundary whose colour makes no difference to the picture.
inline void note_hidden(const cli::Run& run, const TetMesh& m, const std::map<int32_t, std::string>& named,
                        const picture::Colouring& colouring, picture::PictureOptions p, int threads) {
  p.caption = p.edges = p.raster.shade_hollows = false;
  const picture::Image whole = draw_mesh(m, colouring, p, threads);
  for (const auto& [label, name] : named) {
    const std::vector<uint8_t> mark = marked(m, label);
    picture::Colouring other = colouring;
    for (size_t i = 0; i < mark.size(); ++i)
      if (mark[i])
        other.triangle[i] = {0, 0, 0};
    if (draw_mesh(m, other, p, threads).rgb != whole.rgb)
      continue;
    const picture::BestView best = picture::best_view(m, mark, threads);
    run.note("boundary " + name + " does not show in the picture: " +
             (best.pixels == 0
                  ? "it lies within, where a cut may show it (--clip x, y or z, --clip-at)"
                  : "most of it is seen with --azimuth " + std::to_string(std::lround(best.view.azimuth)) +
                        " --elevation " + std::to_string(std::lround(best.view.elevation)) + " --clip none"));
  }
}

} // namespace molmesh
