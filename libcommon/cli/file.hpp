// file.hpp — inputs that may be stdin, outputs that are whole or absent (I10).
#pragma once
#include <fstream>
#include <iosfwd>
#include <string>

namespace molmesh::cli {

/// "-" is standard input. Throws Error(bad_input) when the file cannot be opened or is a directory.
class InputFile {
public:
  explicit InputFile(const std::string& path);
  std::istream& stream();
  /// For messages: the path, or "<stdin>".
  const std::string& name() const { return name_; }

private:
  std::string name_;
  std::ifstream file_;
  bool standard_ = false;
};

/// "-" is standard output. A regular file is written under a temporary name beside it and renamed by commit();
/// without commit() nothing is left behind. Throws Error(not_written).
class OutputFile {
public:
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  std::ostream& stream();
  /// Flush, check, close, rename.
  void commit();

private:
  [[noreturn]] void refuse(const char* what) const;
  std::string path_, temporary_;
  std::ofstream file_;
  bool standard_ = false, direct_ = false;
};

} // namespace molmesh::cli
