// structure_labels.hpp — finds the structure at places of a mesh, and says when it seems to be another mesh's.
#pragma once
#include "base/error.hpp"
#include "cli/run.hpp"
#include "formats/hier/hier.hpp"
#include "formats/vtu/names.hpp"
#include "label/mesh_labels.hpp"
#include "label/other_selection.hpp"
#include "mesh/same_source.hpp"
#include <cmath>
#include <sstream>

namespace molmesh {

[[noreturn]] inline void refuse_selection(const Hierarchy& h, const std::string& file, const std::string& shown,
                                          const std::string& or_else) {
  fail_input(file + ": another selection of " + h.source.substr(0, h.source.find(' ')) + ", " + shown +
             ": expected the atoms of the mesh" + or_else);
}

/// or_else: what else may be done, for the message. Throws Error(bad_input).
inline void require_same_structure(const Hierarchy& h, const std::string& file, const TetMesh& mesh,
                                   const std::string& or_else = "") {
  if (other_structure(h.source, mesh.source))
    fail_input(file + ": the structure is of " + h.source + ", expected the mesh's " + mesh.source + or_else);
}

/// The same, of a file that may be the mesh's with another selection.
inline void require_same_atoms(const Hierarchy& h, const std::string& file, const TetMesh& mesh,
                               const std::string& or_else = "") {
  require_same_structure(h, file, mesh, or_else);
  if (const std::string shown = label::other_number(h, mesh); !shown.empty())
    refuse_selection(h, file, shown, or_else);
}

/// A note where the places of the surface are far from the isosurface. file: of the hierarchy; Error(bad_input)
/// where its atoms are another selection than the mesh's. Empty: any will do.
inline label::Labels labels_at(const label::Places& places, const Hierarchy& h, const TetMesh& mesh, double decay,
                               int threads, const cli::Run& run, const std::string& file,
                               const std::string& or_else = "") {
  label::Labels labels = label::find_labels(h, places.centroid, {decay, mesh.isovalue, threads});
  if (const std::string shown = label::other_selection(h, mesh, places, labels); !file.empty() && !shown.empty())
    refuse_selection(h, file, shown, or_else);
  if (const double off = label::median_offset(places, labels, mesh.isovalue); std::fabs(off) > std::log(3.)) {
    std::ostringstream factor;
    factor.precision(3);
    factor << std::exp(off);
    run.note("half of the surface lies where the density is over " + factor.str() +
             " times the isovalue, expected about 1: is this the mesh's .hier, and its --decay?");
  }
  return labels;
}

/// Labels of the surface's triangles alone, in place of those that the mesh has. file: of the hierarchy.
inline void label_surface(TetMesh& mesh, const std::string& file, int threads, const cli::Run& run) {
  cli::InputFile input(file);
  const Hierarchy h = formats::read_hier(input.stream(), input.name());
  require_same_atoms(h, input.name(), mesh);
  label::Places places = label::places_of(mesh, threads);
  places.cell.erase(places.cell.begin(), places.cell.begin() + places.tets);
  places.centroid.erase(places.centroid.begin(), places.centroid.begin() + places.tets);
  places.tets = 0;
  label::Labels labels = labels_at(places, h, mesh, mesh.decay > 0 ? mesh.decay : 1, threads, run, input.name());
  label::remove_labels(mesh);
  label::add_labels(mesh, places, std::move(labels));
  formats::add_level_names(mesh, h);
}

} // namespace molmesh
