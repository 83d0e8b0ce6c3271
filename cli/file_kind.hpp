// file_kind.hpp — tells what a file is by its first bytes, to say which program reads it.
#pragma once
#include <string>
#include <string_view>

namespace molmesh::cli {

struct FileKind {
  std::string ending; ///< as the programs' pages name it (".vdb"); ".vtu" for every mesh; empty: none that is known
  std::string what;   ///< "a density grid (.vdb)"
  std::string advice; ///< "run density2tet first"
};

/// head: the first bytes of the file, 4,096 are enough.
FileKind file_kind(std::string_view head);

} // namespace molmesh::cli
