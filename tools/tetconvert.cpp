// tetconvert.cpp — a mesh in the formats of other programs, and theirs as .vtu.
#include "tools/options/tetconvert.hpp"
#include "cli/text.hpp"
#include "formats/abaqus/abaqus.hpp"
#include "formats/gmsh/gmsh.hpp"
#include "formats/mcsf/mcsf.hpp"
#include "formats/medit/medit.hpp"
#include "formats/nastran/nastran.hpp"
#include "formats/surface/surface.hpp"
#include "formats/tetgen/tetgen.hpp"
#include "formats/vtu/vtu.hpp"
#include "formats/xdmf/xdmf.hpp"
#include "mesh/straddling.hpp"
#include "tools/charges_file.hpp"
#include "tools/mesh_endings.hpp"
#include <algorithm>
#include <deque>
#include <filesystem>

using namespace molmesh;

namespace {

std::string format_of(const Options& o) {
  return o.format == "auto" ? format_by_ending(o.output) : o.format;
}

/// The output's name without its ending.
std::string stem(const Options& o, const std::string& option) {
  if (o.output == "-" || std::filesystem::is_other(o.output)) // a pipe, a terminal
    fail(Status::usage, option + ": several files, expected -o FILE");
  const std::string end = ending(o.output);
  const bool known =
      std::any_of(mesh_endings.begin(), mesh_endings.end(), [&](const auto& e) { return end == e.first; });
  return o.output.substr(0, o.output.size() - (known ? end.size() : 0));
}

} // namespace

std::vector<std::string> molmesh::Options::outputs() const {
  const std::string f = format_of(*this);
  std::vector<std::string> files{output};
  if (f == "tetgen" || f == "xdmf") {
    const std::string name = stem(*this, "--format " + f);
    files = f == "xdmf" ? std::vector{name + ".xdmf", name + ".h5"}
                        : std::vector{name + ".node", name + ".ele", name + ".face"};
  }
  if (!charges.empty())
    files.push_back(stem(*this, "--charges") + ".charges");
  return files;
}

namespace {

/// In the order of Options::outputs().
using Outputs = std::deque<cli::OutputFile>;

/// Returns how many triangles' labels have no place.
int64_t write_mesh(cli::Run& run, Outputs& outputs, const Options& o, const std::string& format, const TetMesh& m,
                   const std::string& input) {
  std::ostream& out = outputs[0].stream();
  int64_t unplaced = 0;
  if (format == "tetgen") {
    formats::write_tetgen(out, outputs[1].stream(), outputs[2].stream(), m);
  } else if (format == "xdmf") {
    const std::string h5 = o.outputs()[1];
    formats::write_xdmf(out, outputs[1].stream(), h5.substr(h5.rfind('/') + 1), m);
  } else if (format == "vtu")
    formats::write_vtu(out, m);
  else if (format.rfind("gmsh", 0) == 0)
    formats::write_gmsh(out, m,
                        format == "gmsh"     ? formats::GmshVersion::v4_1
                        : format == "gmsh22" ? formats::GmshVersion::v2_2
                                             : formats::GmshVersion::v4_1_binary);
  else if (format == "abaqus")
    formats::write_abaqus(out, m);
  else if (format == "nastran")
    formats::write_nastran(out, m, input);
  else if (format == "medit")
    formats::write_medit(out, m);
  else if (format == "mcsf")
    unplaced = formats::write_mcsf(out, m, input);
  else
    (format == "stl"   ? formats::write_stl
     : format == "ply" ? formats::write_ply
                       : formats::write_off)(out, m, input);
  if (!o.charges.empty())
    run.made = ", " + cli::counted(write_charges_file(outputs.back().stream(), o.charges, m), "charge", "charges");
  for (cli::OutputFile& output : outputs) // the last gets its name first: no .xdmf is without its .h5
    run.complete(output);
  return unplaced;
}

/// What the format has no place for.
void note_losses(const cli::Run& run, const std::string& format, const TetMesh& m, int64_t unplaced) {
  if (format == "xdmf" || format == "vtu")
    return;
  std::string lost;
  const auto lose = [&](const std::string& what) { lost += (lost.empty() ? "" : ", ") + what; };
  const bool gmsh = format == "gmsh" || format == "gmsh-binary", has_arrays = gmsh || format == "ply";
  if (!m.part.empty() && !gmsh && !is_surface(format)) // parts are of tetrahedra
    lose("parts for parallel solvers (tetsmooth --parts)");
  for (const CellArray& a : m.cell_array)
    if (!has_arrays && (a.name != "patch" || format == "stl" || format == "off"))
      lose(a.name);
  for (const NamedText& t : m.named_text)
    if (has_arrays && t.name != "patch_names" && t.name != "boundary_names" && t.name != "region_names")
      lose(t.name);
  if (unplaced > 0)
    lose("labels of " + std::to_string(unplaced) + " triangles between regions");
  if (!lost.empty())
    run.note("left out, " + format + " has no place for them: " + lost);
}

Status run_tool(const Options& o, cli::Run& run) {
  const std::string format = format_of(o);
  run.phase("read");
  cli::InputFile input(o.input);
  Outputs outputs;
  for (const std::string& name : o.outputs())
    outputs.emplace_back(name, cli::OutputFile::Content::binary); // nobody reads a mesh on a terminal
  formats::MeshNotes notes;
  TetMesh mesh = read_mesh(run, input, o.mesh, formats::CellArrays::keep, notes);
  if (mesh.creator.empty())
    mesh.creator = cli::creator("tetconvert");
  if (o.straddle)
    run.counts["moved"] = straddle_surface(mesh);
  run.counts["points"] = mesh.point.size();
  run.counts["tetrahedra"] = mesh.tet.size();
  run.counts["triangles"] = mesh.tri.size();
  run.phase("write");
  const int64_t unplaced = write_mesh(run, outputs, o, format, mesh, input.name());
  note_losses(run, format, mesh, unplaced);
  const int64_t triangles = is_surface(format)
                                ? std::count(mesh.boundary.begin(), mesh.boundary.end(), Boundary::surface)
                                : std::ssize(mesh.tri);
  run.made = format + ": " +
             (is_surface(format) ? "" : cli::counted(std::ssize(mesh.tet), "tetrahedron", "tetrahedra") + ", ") +
             cli::counted(triangles, "triangle", "triangles") + run.made;
  return Status::good;
}

} // namespace

int main(int argc, char** argv) {
  return cli::run_main<Options>("tetconvert",
                                "Converts a mesh between .vtu and the formats of solvers and viewers, tags intact.",
                                argc, argv, describe, run_tool);
}
