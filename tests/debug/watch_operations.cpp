// watch_operations.cpp — improves a mesh and writes what operations leave: the region after the one that breaks it,
// or after each of one name. Built with MOLMESH_CHECK_OPERATIONS.
//
//   watch_operations MESH.vtu DENSITY.vdb|- FOLDER [OPERATION [COUNT]]
//
// OPERATION: "edge split", …, the name that it gives to Region::done(); any: all of them. The first COUNT (10) are
// written to FOLDER/0001-edge-split.vtu, …; one that breaks a rule always is, and ends the run with status 1.
#include "base/error.hpp"
#include "formats/vdb/vdb.hpp"
#include "formats/vtu/vtu.hpp"
#include "optimize/operations/check.hpp"
#include "optimize/optimize.hpp"
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <optional>

using namespace molmesh;

namespace {

std::string folder, wanted;
int64_t left = 10, operations = 0;

void watch(const optimize::Region& region, const char* operation) {
  ++operations;
  const std::string fault = optimize::find_fault(region);
  const bool asked = left > 0 && (wanted == "any" || wanted == operation);
  if (fault.empty() && !asked)
    return;
  left -= asked;
  std::string name = operation;
  std::replace(name.begin(), name.end(), ' ', '-');
  char number[24];
  std::snprintf(number, sizeof number, "%04lld", static_cast<long long>(operations));
  const std::string path = folder + "/" + number + "-" + name + ".vtu";
  std::ofstream out(path, std::ios::binary);
  formats::write_vtu(out, optimize::as_mesh(region));
  if (!out)
    fail(Status::not_written, path + ": not written");
  std::cout << path << (fault.empty() ? "" : ": " + fault) << std::endl;
  if (!fault.empty())
    fail(Status::failed, std::string(operation) + ": " + fault);
}

} // namespace

int main(int argc, char** argv) try {
  if (argc < 4 || argc > 6) {
    std::cerr << "watch_operations MESH.vtu DENSITY.vdb|- FOLDER [OPERATION [COUNT]]\n";
    return 2;
  }
  folder = argv[3];
  wanted = argc > 4 ? argv[4] : "";
  left = argc > 5 ? std::stoll(argv[5]) : left;
  std::ifstream in(argv[1], std::ios::binary);
  TetMesh mesh = formats::read_vtu(in, argv[1]);
  std::optional<BlockGrid> density;
  if (argv[2] != std::string("-")) {
    std::ifstream grid(argv[2], std::ios::binary);
    density = formats::read_vdb(grid, argv[2], 1);
  }
  optimize::after_operation = watch; // on one thread: in order, and what is counted is nobody else's
  const auto result = optimize::improve(mesh, density ? &*density : nullptr, {});
  std::cout << operations << " operations, dihedral angles " << result.after.min << "° to " << result.after.max
            << "°\n";
  return 0;
} catch (const std::exception& e) {
  std::cerr << "watch_operations: " << e.what() << '\n';
  return 1;
}
