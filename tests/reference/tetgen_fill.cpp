// tetgen_fill.cpp — the one file that sees TetGen.
#define TETLIBRARY
#include "oracles.hpp"
#include <map>
#include <stdexcept>
#include <string>
#include <tetgen.h>

namespace molmesh::reference {

TetMesh tetgen_fill(const std::vector<Vec3d>& point, const std::vector<Tri>& tri, const std::vector<Vec3d>& holes,
                    const std::string& quality) {
  tetgenio in, out; // free what their lists point to
  std::map<int32_t, int> number;
  for (const Tri& t : tri)
    for (int32_t v : t)
      number.try_emplace(v, static_cast<int>(number.size()));
  in.numberofpoints = static_cast<int>(number.size());
  in.pointlist = new REAL[3 * number.size()];
  for (const auto& [v, i] : number)
    for (int k = 0; k < 3; ++k)
      in.pointlist[3 * i + k] = point[v][k];
  in.numberoffacets = static_cast<int>(tri.size());
  in.facetlist = new tetgenio::facet[tri.size()];
  for (size_t f = 0; f < tri.size(); ++f) {
    tetgenio::facet& facet = in.facetlist[f];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    facet.polygonlist[0].numberofvertices = 3;
    facet.polygonlist[0].vertexlist = new int[3];
    for (size_t i = 0; i < 3; ++i)
      facet.polygonlist[0].vertexlist[i] = number.at(tri[f][i]);
  }
  if (!holes.empty()) {
    in.numberofholes = static_cast<int>(holes.size());
    in.holelist = new REAL[3 * holes.size()];
    for (size_t i = 0; i < holes.size(); ++i)
      for (int k = 0; k < 3; ++k)
        in.holelist[3 * i + static_cast<size_t>(k)] = holes[i][k];
  }
  std::string switches = "pYQ" + quality; // a piecewise linear complex, surface kept, quiet
  try {
    tetrahedralize(switches.data(), &in, &out);
  } catch (int code) {
    throw std::runtime_error("TetGen gives up with code " + std::to_string(code));
  }
  TetMesh m;
  for (int i = 0; i < out.numberofpoints; ++i)
    m.point.push_back({out.pointlist[3 * i], out.pointlist[3 * i + 1], out.pointlist[3 * i + 2]});
  for (int i = 0; i < out.numberoftetrahedra; ++i) {
    const int* t = out.tetrahedronlist + 4 * i;
    m.tet.push_back({t[0], t[1], t[2], t[3]});
    m.region.push_back(1);
  }
  return m;
}

} // namespace molmesh::reference
