// tetreport.hpp — options and page of tetreport.
#pragma once
#include "tools/options/mesh_input.hpp"
#include <optional>

namespace molmesh {

struct Options : cli::Common {
  Options() {
    output.clear();
    chooses_format = shows_every_output = true;
  }
  MeshInput mesh;
  std::vector<std::string> meshes, runs; ///< meshes: after the first
  std::string png, colour = "auto", clip = "auto", region = "auto", title;
  std::optional<double> clip_at, azimuth, elevation;
  int width = 1200, height = 900;
  double most_megabytes = 30;
  bool check = false, no_edges = false;

  std::vector<std::string> outputs() const override {
    std::vector<std::string> files;
    for (const std::string& file : {output, png})
      if (!file.empty())
        files.push_back(file);
    return files.empty() ? std::vector<std::string>{"-"} : files;
  }
};

inline void describe(cli::Table& t, Options& o) {
  t.add("meshes", o.meshes, "more meshes, for a gallery");
  t.group("report");
  t.add("--title", o.title, "of the page and the picture; the mesh's name by default");
  t.add("--check", o.check, "also check whether the meshes are valid, as tetstat does");
  t.add("--runs", o.runs, "run report (--report of any program) of a run that led to a mesh").unit("FILE");
  t.add("--most", o.most_megabytes,
        "about what the page may have; what does not fit is left out, and the page says so")
      .unit("MB")
      .within(2, 2000);
  t.group("picture");
  const std::vector<std::string> picture = {"png", "meshes"}; // a gallery has one of each mesh
  t.add("--png", o.png, "write a picture of one mesh to this file").unit("PICTURE");
  t.add("--colour", o.colour,
        "of the surface, the page's at first, too: plain, region, body, boundary, part, chain, residue or another "
        "integer array; auto: the first of named boundaries, chain, regions that there is")
      .unit("LABEL");
  t.quantity("colour", "--colour");
  t.add("--clip", o.clip,
        "what is taken away: the side of x, y or z that faces the viewer, of both x and y (a corner), or "
        "nothing; whole tetrahedra stay; auto: a corner, but of named boundaries nothing")
      .one_of({"auto", "x", "y", "z", "corner", "none"})
      .needs(picture);
  t.add("--clip-at", o.clip_at, "where, as a share of the mesh's extent")
      .within(0, 1)
      .shown_default("0.5")
      .needs(picture);
  t.add("--region", o.region,
        "shown: the molecule and its cavities, what is around, or both; auto: the molecule if any")
      .one_of({"auto", "interior", "exterior", "both"});
  t.add("--azimuth", o.azimuth,
        "where the viewer stands, from +x to +y; auto: -60, or where one named boundary shows best")
      .unit("°")
      .within(-360, 360)
      .shown_default("auto")
      .needs(picture);
  t.add("--elevation", o.elevation, "and how high; auto: 25, or as that")
      .unit("°")
      .within(-90, 90)
      .shown_default("auto")
      .needs(picture);
  t.add("--width", o.width, "pixels").within(64, 8192).needs({"png"});
  t.add("--height", o.height, "pixels").within(64, 8192).needs({"png"});
  t.add("--no-edges", o.no_edges, "draw no edges of triangles").needs(picture);
  describe_mesh_input(t, o.mesh);
  t.page.about = "Makes one HTML file that any browser opens without a network: the mesh in 3D, coloured by its "
                 "labels, cut open "
                 "so that whole tetrahedra show, bodies and cavities switched on and off; histograms; the worst "
                 "elements and the "
                 "residues there; volumes, areas, origin. Of several meshes it makes a gallery with pictures and a "
                 "table. With "
                 "--png it draws a picture, which needs no display. Of one mesh it can do both.";
  t.page.examples = {{"tetreport 1tii.vtu -o 1tii.html", "the page of one mesh"},
                     {"tetreport FOLDER/*.vtu -o all.html", "a gallery"},
                     {"tetreport 1tii.vtu --png 1tii.png", "a picture, without a page"},
                     {"tetreport 1tii.vtu --png cut.png --clip x --clip-at 0.4 --region both", "another cut"}};
  t.page.files = {{".vtu, .msh, .mesh, .vtk", "mesh, read: formats/mesh/MESH.md"},
                  {".html", "the report, written: formats/html/HTML.md"},
                  {".png", "picture, written: formats/png/PNG.md"},
                  {".json", "run reports, read: formats/report/REPORTv1.md"}};
  t.page.several = "several meshes as FOLDER/*.vtu";
  t.page.see_also = {"tetstat", "tetlabel", "tetconvert"};
}

} // namespace molmesh
