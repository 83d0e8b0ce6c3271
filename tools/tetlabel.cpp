// tetlabel.cpp — a mesh (.vtu) and its structure (.hier) to the mesh with the structure's labels.
#include "tools/options/tetlabel.hpp"
#include "cli/text.hpp"
#include "formats/pdb/hier_selection.hpp"
#include "formats/vtu/vtu.hpp"
#include "molecule/words.hpp"
#include "tools/boundary_notes.hpp"
#include "tools/structure_labels.hpp"
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

using namespace molmesh;

namespace {

std::vector<label::NamedBoundary> select(const Options& o, const Hierarchy& h, const cli::Run& run) {
  std::vector<label::NamedBoundary> boundary;
  for (const std::string& text : o.boundary) {
    const size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
      fail(Status::usage, "--boundary: found '" + text + "', expected NAME=SELECTION");
    const std::string name = text.substr(0, equals);
    if (name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-") !=
        std::string::npos)
      fail(Status::usage, "--boundary: found the name '" + name + "', expected letters, digits, _ and -");
    if (formats::is_own_name(name))
      fail(Status::usage, "--boundary: found the name '" + name + "', which is the meshes' own, expected another");
    std::vector<std::string> absent;
    const std::vector<uint8_t> atom =
        formats::select_atoms(h, text.substr(equals + 1), "--boundary " + name, &absent);
    for (const std::string& number : absent)
      run.note("boundary " + name + ": no residue fits " + number + " of '" + text.substr(equals + 1) + "'");
    const auto same = std::find_if(boundary.begin(), boundary.end(), [&](const auto& b) { return b.name == name; });
    if (same == boundary.end())
      boundary.push_back({name, atom});
    else // one boundary of several selections
      std::transform(atom.begin(), atom.end(), same->atom.begin(), same->atom.begin(), std::bit_or<>());
  }
  return boundary;
}

/// 0: auto.
double parse_decay(const std::string& text) {
  if (text == "auto")
    return 0;
  const std::optional<double> decay = decimal(text);
  if (!decay || !(*decay > 0))
    fail(Status::usage, "--decay: found '" + text + "', expected auto or a number > 0");
  return *decay;
}

/// asked: o.decay.
double decay_of(const Options& o, double asked, const TetMesh& mesh) {
  if (asked > 0 && mesh.decay > 0 && std::fabs(asked - mesh.decay) > 1e-9 * mesh.decay)
    fail(Status::usage, "--decay: found " + o.decay + ", expected " + std::to_string(mesh.decay) +
                            ", which the mesh was made with");
  return asked > 0 ? asked : mesh.decay > 0 ? mesh.decay : 1;
}

Status run_tool(const Options& o, cli::Run& run) {
  if (o.input == "-" && o.hierarchy == "-")
    fail(Status::usage, "both inputs are standard input, expected at most one");
  const double asked_decay = parse_decay(o.decay); // before any work
  run.phase("read");
  cli::InputFile structure(o.hierarchy), input(o.input);
  cli::OutputFile output(o.output, cli::OutputFile::Content::binary);
  const Hierarchy h = formats::read_hier(structure.stream(), structure.name());
  const std::vector<label::NamedBoundary> boundary = select(o, h, run);
  formats::MeshNotes notes;
  TetMesh mesh = read_mesh(run, input, o.mesh, formats::CellArrays::keep, notes);
  if (!o.other_structure)
    require_same_atoms(h, structure.name(), mesh, ", or --other-structure");

  run.phase("label");
  const label::Places places = label::places_of(mesh, o.resolved_threads());
  if (places.cell.empty())
    fail_input(input.name() + ": no tetrahedron of region 1 and no triangle of boundary 1, expected a molecule");
  label::Labels labels = labels_at(places, h, mesh, decay_of(o, asked_decay, mesh), o.resolved_threads(), run,
                                   o.other_structure ? "" : structure.name(), ", or --other-structure");
  run.counts["tetrahedra"] = places.tets;
  run.counts["triangles"] = static_cast<int64_t>(places.cell.size()) - places.tets;
  label::remove_labels(mesh);
  label::Patches patches;
  if (!boundary.empty()) { // else those of a former run stay
    label::remove_patches(mesh);
    patches = label::add_patches(mesh, places, labels, boundary);
  }
  std::map<int32_t, std::string> names;
  for (size_t b = 0; b < boundary.size(); ++b) {
    if (patches.count[b] == 0)
      refuse_empty(boundary, b, patches, input.name());
    run.counts["boundary " + boundary[b].name] = patches.count[b];
    note_buried(run, patches, b, boundary[b].name);
    note_unseen(run, label::unseen_residues(h, places, labels, boundary[b]), boundary[b].name);
    names[patches.first + static_cast<int32_t>(b)] = boundary[b].name;
    run.made += ", boundary " + boundary[b].name + ": " + counted_triangles(patches, b);
  }
  label::add_labels(mesh, places, std::move(labels));
  formats::add_level_names(mesh, h);
  if (!boundary.empty())
    formats::add_patch_names(mesh, names);

  run.phase("write");
  const std::string own = ", " + cli::creator("tetlabel"); // tetsmooth looks at who made the mesh
  if (mesh.creator.size() < own.size() ||
      mesh.creator.compare(mesh.creator.size() - own.size(), own.size(), own) != 0)
    mesh.creator += own;
  formats::write_vtu(output.stream(), mesh);
  run.complete(output);
  run.made = "labels of " + cli::counted(places.tets, "tetrahedron", "tetrahedra") + " and " +
             cli::counted(static_cast<int64_t>(places.cell.size()) - places.tets, "triangle", "triangles") +
             run.made;
  return Status::good;
}

} // namespace

int main(int argc, char** argv) {
  return cli::run_main<Options>(
      "tetlabel", "Names the structure at every triangle and tetrahedron of a molecule's mesh (.vtu, .hier).", argc,
      argv, describe, run_tool);
}
