// pqr_fuzz.cpp — the reader of PQR.
#include "structure_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  molmesh::fuzz::structure(data, size, "pqr");
  return 0;
}
