// notes.hpp — what was kept, what was dropped and why, in words.
#pragma once
#include "formats/pdb/parse.hpp"
#include "formats/pdb/pdb.hpp"

namespace molmesh::formats {

/// Puts the sentences before what report.notes already holds.
void add_notes(PdbReport& report, const Parsed& parsed, const PdbOptions& options);

} // namespace molmesh::formats
