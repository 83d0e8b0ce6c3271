// mmjson_fuzz.cpp — the reader of mmJSON.
#include "structure_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  molmesh::fuzz::structure(data, size, "mmjson");
  return 0;
}
