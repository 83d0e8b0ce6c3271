// passed_over.hpp — lines that are no atoms are counted by record; atoms under another name are refused.
#pragma once
#include "formats/pdb/parse.hpp"

namespace molmesh::formats {

/// Of the PDB format and those that are written like it (PQR, PDBQT).
class PassedOver {
public:
  explicit PassedOver(const std::string& file) : file_(file) {}
  /// line: not one of those that are read. Throws Error(bad_input) when it holds an atom: behind a blank, or under
  /// a name that is no record's.
  void take(std::string_view line, int64_t number);
  /// Into parsed.passed_over, and a note on lines of no known record.
  void report(Parsed& parsed) const;

private:
  const std::string& file_;
  std::map<std::string, int64_t> count_;
  int64_t unknown_ = 0, first_line_ = 0;
  std::string first_;
};

} // namespace molmesh::formats
