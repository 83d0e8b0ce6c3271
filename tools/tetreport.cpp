// tetreport.cpp — meshes to a page for browsers, or to a picture.
#include "tools/options/tetreport.hpp"
#include "cli/text.hpp"
#include "formats/html/html.hpp"
#include "formats/html/run_reports.hpp"
#include "formats/png/png.hpp"
#include "formats/read_all.hpp"
#include "tools/report_names.hpp"
#include "tools/report_view.hpp"
#include <algorithm>
#include <optional>
#include <ostream>

using namespace molmesh;

namespace {

struct Loaded {
  TetMesh mesh;
  std::vector<std::string> notes;
  TriangleSides sides;
  MeshBodies bodies;
  std::vector<formats::CellLabel> labels;
  std::string colour;
};

Loaded load(const std::string& path, const Options& o, cli::Run& run) {
  const int threads = o.resolved_threads();
  run.phase("read");
  cli::InputFile input(path);
  Loaded l;
  formats::MeshNotes notes;
  l.mesh = read_mesh(run, input, o.mesh, formats::CellArrays::keep, notes);
  l.notes = described(notes);
  run.phase("neighbors");
  l.sides = triangle_sides(l.mesh, threads);
  l.bodies = find_bodies(l.mesh, l.sides.across);
  l.labels = formats::cell_labels(l.mesh);
  l.colour = o.colour == "auto" ? formats::usual_colour(l.mesh, l.labels) : o.colour;
  return l;
}

std::string draw(const Loaded& l, const std::string& name, const Options& o, int width, int height, bool caption,
                 cli::Run& run) {
  run.phase("picture");
  picture::PictureOptions p;
  p.raster.width = width;
  p.raster.height = height;
  p.region = shown_regions(o, l.mesh);
  const auto named = l.colour == "boundary" ? formats::user_boundaries(l.mesh) : std::map<int32_t, std::string>();
  const int threads = o.resolved_threads();
  p.view = view_of(o, l.mesh, named, p.region, threads);
  const std::string axes = cut_axes(o, named, p.region);
  const auto [low, high] = box_of(l.bodies, p.region);
  p.cut = picture::cut_facing(p.view, axes, o.clip_at.value_or(0.5), low, high);
  p.edges = !o.no_edges;
  p.caption = caption;
  p.title = name;
  const picture::Colouring c = formats::colouring_by(l.colour, l.mesh, l.sides, l.bodies, l.labels);
  if (caption && !named.empty())
    note_hidden(run, l.mesh, named, c, p, threads);
  return formats::png(draw_mesh(l.mesh, c, p, threads));
}

Status run_tool(const Options& o, cli::Run& run) {
  check_report_names(o.output, o.png);
  if (o.clip == "none" && o.clip_at)
    fail(Status::usage, "--clip-at: found with --clip none, expected --clip x, y, z or corner");
  std::vector<std::string> paths{o.input};
  paths.insert(paths.end(), o.meshes.begin(), o.meshes.end());
  if (!o.png.empty() && paths.size() > 1)
    fail(Status::usage, "--png: found " + std::to_string(paths.size()) + " meshes, expected one");
  if (std::count(paths.begin(), paths.end(), "-") > 1)
    fail(Status::usage, "standard input is given twice, expected at most once");
  if (const std::string note = unimproved_note(paths); !note.empty())
    run.note(note);
  const bool page = !o.output.empty() || o.png.empty();
  std::optional<cli::OutputFile> html, png;
  if (page)
    html.emplace(o.output.empty() ? "-" : o.output, cli::OutputFile::Content::binary);
  if (!o.png.empty())
    png.emplace(o.png, cli::OutputFile::Content::binary);
  std::vector<formats::RunReport> runs;
  for (const std::string& file : o.runs) {
    cli::InputFile input(file);
    runs.push_back(formats::read_run_report(formats::read_all(input.stream(), input.name()), input.name()));
  }
  if (page && !formats::HtmlReport::has_3d())
    run.note("built without three.js (Debian: libjs-three): the page has stills, and nothing in 3D");

  formats::HtmlReport report(static_cast<int64_t>(o.most_megabytes * 1e6), static_cast<int64_t>(paths.size()));
  int64_t tets = 0;
  for (const std::string& path : paths) {
    const Loaded l = load(path, o, run);
    const std::string name = paths.size() == 1 && !o.title.empty() ? o.title
                             : path == "-"                         ? "mesh"
                                                                   : base_name(path);
    tets += static_cast<int64_t>(l.mesh.tet.size());
    if (png)
      png->stream() << draw(l, name, o, o.width, o.height, true, run);
    if (!page)
      continue;
    formats::ReportedMesh more{name, path,    l.notes, {}, formats::runs_of(runs, path, paths.size() == 1),
                               {},   l.colour};
    const int width = paths.size() == 1 ? 800 : paths.size() <= 60 ? 400 : 240;
    more.picture = draw(l, name, o, width, width * 3 / 4, false, run);
    if (o.check) {
      run.phase("validity");
      more.validity = check_validity(l.mesh, o.resolved_threads());
    }
    run.phase("page");
    report.add(l.mesh, l.sides, l.bodies, l.labels, more, o.resolved_threads());
  }
  run.phase("write");
  if (page) {
    run.notes(report.left_out());
    report.write(html->stream(), o.title.empty() ? "Meshes" : o.title, cli::creator("tetreport"));
    run.complete(*html);
  }
  if (png)
    run.complete(*png);
  run.counts["meshes"] = paths.size();
  run.counts["tetrahedra"] = tets;
  run.made =
      cli::counted(std::ssize(paths), "mesh", "meshes") + ", " + cli::counted(tets, "tetrahedron", "tetrahedra");
  return Status::good;
}

} // namespace

int main(int argc, char** argv) {
  return cli::run_main<Options>("tetreport", "Meshes to a page that shows them in a browser, or to a picture.",
                                argc, argv, describe, run_tool);
}
