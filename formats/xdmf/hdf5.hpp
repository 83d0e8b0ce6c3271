// hdf5.hpp — an HDF5 file in memory, the same bytes for the same datasets.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <set>
#include <string>

namespace molmesh::formats {

class Hdf5File {
public:
  Hdf5File();
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;
  /// A dataset [rows][columns] in a group that is made when new. The name is changed where HDF5 or
  /// the group cannot have it; returns "/GROUP/NAME".
  std::string add(const std::string& group, const std::string& name, uint64_t rows, uint64_t columns,
                  const int32_t* values);
  std::string add(const std::string& group, const std::string& name, uint64_t rows, uint64_t columns,
                  const double* values);
  /// A UTF-8 string.
  std::string add(const std::string& group, const std::string& name, const std::string& text);
  void write(std::ostream& out);

private:
  std::string path(const std::string& group, const std::string& name);
  void add(const std::string& path, int64_t type, int rank, const uint64_t* extent, const void* values);
  int64_t file_ = -1;
  std::set<std::string> taken_;
};

} // namespace molmesh::formats
