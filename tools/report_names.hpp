// report_names.hpp — refuses names of a page and a picture whose endings promise another kind of file; tells of
// meshes given twice.
#pragma once
#include "base/error.hpp"
#include "tools/mesh_endings.hpp"
#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace molmesh {

inline std::string base_name(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

/// Empty: not given. Any other name is taken, one without an ending, too. Throws Error(usage).
inline void check_report_names(const std::string& page, const std::string& picture) {
  const auto is_picture = [](const std::string& end) {
    constexpr std::array endings = {".png",  ".jpg", ".jpeg", ".gif", ".svg", ".tif",
                                    ".tiff", ".bmp", ".webp", ".pdf", ".eps", ".ps"};
    return std::find(endings.begin(), endings.end(), end) != endings.end();
  };
  const auto as_png = [](const std::string& name) { return name.substr(0, name.rfind('.')) + ".png"; };
  if (is_picture(ending(page)))
    fail(Status::usage, "-o: found " + page + ", expected a page, as " + page.substr(0, page.rfind('.')) +
                            ".html; a picture is --png " + as_png(page));
  const std::string end = ending(picture);
  if (end == ".html" || end == ".htm")
    fail(Status::usage, "--png: found " + picture + ", expected a name that ends in .png; a page is -o " + picture);
  if (end != ".png" && is_picture(end))
    fail(Status::usage, "--png: found " + picture + ", expected a name that ends in .png, as " + as_png(picture));
}

/// A note where meshes are given before and after improvement, as X.tet.vtu and X.vtu by FOLDER/*.vtu; else empty.
inline std::string unimproved_note(const std::vector<std::string>& paths) {
  const std::set<std::string> all(paths.begin(), paths.end());
  constexpr std::string_view before = ".tet.vtu";
  std::string first, after;
  int64_t count = 0;
  for (const std::string& path : paths) {
    const size_t stem = path.size() - std::min(path.size(), before.size());
    if (path.substr(stem) != before || all.count(path.substr(0, stem) + ".vtu") == 0)
      continue;
    if (count++ == 0)
      first = path, after = path.substr(0, stem) + ".vtu";
  }
  if (count == 0)
    return "";
  return std::to_string(count) + (count == 1 ? " mesh" : " meshes") +
         " before improvement beside those after it, as " + first + " and " + after +
         ": leave them out where the latter are enough";
}

} // namespace molmesh
