// hdf5.cpp — HDF5's C library with its core driver: nothing on disk until the whole file is known.
#include "formats/xdmf/hdf5.hpp"
#include "base/error.hpp"
#include <hdf5.h>
#include <ostream>
#include <vector>

namespace molmesh::formats {
namespace {

/// An identifier or size of HDF5, negative when the call failed.
template <class T>
T good(T result, const char* what) {
  if (result < 0)
    fail(Status::failed, std::string("HDF5: cannot ") + what);
  return result;
}

} // namespace

Hdf5File::Hdf5File() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // it prints on stderr otherwise
  const hid_t access = good(H5Pcreate(H5P_FILE_ACCESS), "set up");
  good(H5Pset_fapl_core(access, size_t{1} << 24, false), "set up");
  file_ = H5Fcreate("memory", H5F_ACC_TRUNC, H5P_DEFAULT, access);
  H5Pclose(access);
  good(file_, "begin a file");
}

Hdf5File::~Hdf5File() {
  H5Fclose(file_);
}

std::string Hdf5File::path(const std::string& group, const std::string& name) {
  std::string word;
  for (const char c : name)
    word += c > ' ' && c < 0x7F && c != '/' && c != ':' && c != '<' && c != '&' ? c : '_';
  std::string path = "/" + group + "/" + (word.empty() || word == "." ? "array" : word);
  while (!taken_.insert(path).second)
    path += "_";
  return path;
}

std::string Hdf5File::add(const std::string& group, const std::string& name, uint64_t rows, uint64_t columns,
                          const int32_t* values) {
  const std::string at = path(group, name);
  const uint64_t extent[] = {rows, columns};
  add(at, H5T_STD_I32LE, 2, extent, values);
  return at;
}

std::string Hdf5File::add(const std::string& group, const std::string& name, uint64_t rows, uint64_t columns,
                          const double* values) {
  const std::string at = path(group, name);
  const uint64_t extent[] = {rows, columns};
  add(at, H5T_IEEE_F64LE, 2, extent, values);
  return at;
}

std::string Hdf5File::add(const std::string& group, const std::string& name, const std::string& text) {
  const std::string at = path(group, name);
  const hid_t type = good(H5Tcopy(H5T_C_S1), "make a type");
  H5Tset_size(type, text.size() + 1);
  H5Tset_cset(type, H5T_CSET_UTF8);
  add(at, type, 0, nullptr, text.c_str());
  H5Tclose(type);
  return at;
}

void Hdf5File::add(const std::string& path, int64_t type, int rank, const uint64_t* extent, const void* values) {
  std::vector<hsize_t> size(extent, extent + rank);
  const hid_t space =
      good(rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, size.data(), nullptr), "make a data space");
  const hid_t links = good(H5Pcreate(H5P_LINK_CREATE), "set up"),
              plain = good(H5Pcreate(H5P_DATASET_CREATE), "set up");
  H5Pset_create_intermediate_group(links, 1);
  H5Pset_obj_track_times(plain, false); // same mesh, same bytes
  const hid_t set = good(H5Dcreate2(file_, path.c_str(), type, space, links, plain, H5P_DEFAULT), "make a dataset");
  // Little-endian in memory too (a static_assert of the .vtu writer).
  good(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "write a dataset");
  H5Dclose(set);
  H5Pclose(plain);
  H5Pclose(links);
  H5Sclose(space);
}

void Hdf5File::write(std::ostream& out) {
  good(H5Fflush(file_, H5F_SCOPE_GLOBAL), "finish the file");
  const auto size = good(H5Fget_file_image(file_, nullptr, 0), "tell the file's size");
  std::vector<char> image(static_cast<size_t>(size));
  good(H5Fget_file_image(file_, image.data(), image.size()), "copy the file");
  out.write(image.data(), static_cast<std::streamsize>(image.size()));
}

} // namespace molmesh::formats
