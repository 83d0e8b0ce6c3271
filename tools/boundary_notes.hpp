// boundary_notes.hpp — named boundaries in the words of tetlabel: what is in them, what is not, why one is empty.
#pragma once
#include "base/grouped.hpp"
#include "cli/run.hpp"
#include "cli/text.hpp"
#include "label/unseen_residues.hpp"
#include <algorithm>

namespace molmesh {

/// Buried residues, and those whose atoms others cover: a boundary condition does not reach them.
inline void note_unseen(const cli::Run& run, const label::UnseenResidues& u, const std::string& name) {
  constexpr size_t most = 6;
  if (u.unseen.empty())
    return;
  std::string line = "boundary " + name + ": no triangle of the surface belongs to " +
                     std::to_string(u.unseen.size()) + " of its " +
                     cli::counted(u.residues, "residue", "residues") + ": ";
  for (size_t i = 0; i < std::min(u.unseen.size(), most); ++i)
    line += (i > 0 ? ", " : "") + u.unseen[i];
  if (u.unseen.size() > most)
    line += " and " + std::to_string(u.unseen.size() - most) + " more";
  run.note(line);
}

/// Where nothing from outside comes to a boundary at all.
inline void note_buried(const cli::Run& run, const label::Patches& patches, size_t b, const std::string& name) {
  if (patches.walls[b] == patches.count[b])
    run.note("boundary " + name + ": no triangle of the outer surface belongs to it: all " +
             grouped(patches.count[b]) +
             " are on walls of closed cavities, which nothing outside reaches; residues "
             "around it are selected by 'around SELECTION 4'");
}

[[noreturn]] inline void refuse_empty(const std::vector<label::NamedBoundary>& boundary, size_t b,
                                      const label::Patches& patches, const std::string& mesh) {
  const std::string which = "--boundary " + boundary[b].name + ": ";
  std::string later;
  for (const size_t l : patches.taken_by[b])
    later += (later.empty() ? "" : ", ") + boundary[l].name;
  fail_input(later.empty()
                 ? which + "no triangle of " + mesh + "'s surface belongs to it, expected at least one"
                 : which + "all its triangles belong to " + later + ", given later: expected it after " + later);
}

/// "905", "905 (24 on walls of closed cavities)": solvent, and what it carries, does not come to these.
inline std::string counted_triangles(const label::Patches& patches, size_t b) {
  const std::string count = grouped(patches.count[b]);
  return patches.walls[b] == 0 ? count : count + " (" + grouped(patches.walls[b]) + " on walls of closed cavities)";
}

} // namespace molmesh
