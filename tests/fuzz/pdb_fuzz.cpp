// pdb_fuzz.cpp — the reader of PDB files, gzip, and the choice of format.
#include "structure_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  molmesh::fuzz::structure(data, size, "auto");
  return 0;
}
