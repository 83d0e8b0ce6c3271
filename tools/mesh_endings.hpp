// mesh_endings.hpp — formats of meshes by the endings of files' names.
#pragma once
#include "base/error.hpp"
#include "base/small_letters.hpp"
#include <string>
#include <utility>
#include <vector>

namespace molmesh {

/// By the ending of the output's name. Those of several files are named by any of them.
inline const std::vector<std::pair<const char*, const char*>> mesh_endings = {
    {".msh", "gmsh"},   {".msh2", "gmsh22"}, {".mesh", "medit"},  {".node", "tetgen"},
    {".ele", "tetgen"}, {".face", "tetgen"}, {".xdmf", "xdmf"},   {".h5", "xdmf"},
    {".m", "mcsf"},     {".stl", "stl"},     {".ply", "ply"},     {".off", "off"},
    {".inp", "abaqus"}, {".bdf", "nastran"}, {".nas", "nastran"}, {".vtu", "vtu"}};

/// Whether the format holds the triangles of boundary 1 and nothing else.
inline bool is_surface(const std::string& format) {
  return format == "stl" || format == "ply" || format == "off";
}

/// In small letters, with its dot; empty: none.
inline std::string ending(const std::string& path) {
  const size_t name = path.rfind('/') + 1, dot = path.rfind('.');
  return dot == std::string::npos || dot <= name ? "" : small_letters(path.substr(dot));
}

/// Throws Error(usage) that lists what there is.
inline std::string format_by_ending(const std::string& output) {
  const std::string end = ending(output);
  std::string known;
  for (const auto& [e, format] : mesh_endings) {
    if (end == e)
      return format;
    known += (known.empty() ? "" : ", ") + std::string(e);
  }
  fail(Status::usage, "-o: " + (output == "-" ? "none given" : "found " + output) +
                          ", expected a name that ends in one of " + known + ", or --format");
}

} // namespace molmesh
