// mmcif_fuzz.cpp — the reader of mmCIF.
#include "structure_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  molmesh::fuzz::structure(data, size, "mmcif");
  return 0;
}
