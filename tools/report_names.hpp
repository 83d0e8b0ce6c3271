// report_names.hpp — refuses names of a page and a picture whose endings promise another kind of file.
#pragma once
#include "base/error.hpp"
#include "tools/mesh_endings.hpp"
#include <algorithm>
#include <array>

namespace molmesh {

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

} // namespace molmesh
