// file_kind.hpp — tells what a file is by its first bytes, to say what to do with one that was given to the wrong
// program.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace molmesh::cli {

/// What programs read; `other`: what none of them does.
enum class Kind { unknown, structure, hierarchy, density, mesh, map, plan, report, table, other };

struct FileKind {
  Kind kind = Kind::unknown;
  std::string what; ///< "a density grid (.vdb)"; empty: unknown
  std::string way;  ///< of `other`: what to do with it
};

/// head: the first bytes of the file, 4,096 are enough. size: of the whole file in bytes; 0: not known.
FileKind file_kind(std::string_view head, uint64_t size = 0);

/// Of a file of 0 bytes, or of a pipe that ended before its first.
FileKind empty_file();

struct OpenedFile {
  FileKind kind;
  bool packed = false; ///< by gzip; `kind` is that of what is in it
};
/// kind.what is empty for a file that cannot be read.
OpenedFile look_at_file(const std::string& path);

/// By the ending of its name, in letters of any case, .gz left out; `other`: pages and pictures, `unknown`: an
/// ending that is none of a known kind, or none.
Kind kind_by_name(const std::string& path);

/// "a hierarchy of atoms (.hier)"
std::string name_of(Kind kind);

/// Which programs make the wanted kind of what was found, or what else to do: "run pdb2hier, then hier2density
/// first". program: the one that was asked. main_input: found in the place of its main input, so that another
/// program may take the file.
std::string advice(const FileKind& found, Kind wanted, const std::string& program, bool main_input);

} // namespace molmesh::cli
