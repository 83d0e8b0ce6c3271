// rules_fuzz.cpp — files of rules, domains and radii, and the selections in them; the first byte tells which.
#include "molecule/radii.hpp"
#include "structure_fuzz.hpp"

using namespace molmesh;

namespace {

const char structure[] = "ATOM      1  N   GLY A   1       0.000   0.000   0.000  1.00 10.00           N  \n"
                         "ATOM      2  CA  GLY A   1       1.500   0.000   0.000  1.00 10.00           C  \n"
                         "ATOM      3  CA AALA A   2A      3.000   0.000   0.000  0.50 10.00           C  \n"
                         "ATOM      4  CA  ALA B   1       9.000   0.000   0.000  1.00 10.00           C  \n"
                         "HETATM    5 ZN    ZN     1      12.000   0.000   0.000  1.00 10.00          ZN  \n";

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0)
    return 0;
  std::istringstream in(std::string(reinterpret_cast<const char*>(data) + 1, size - 1));
  formats::PdbOptions options;
  try {
    switch (data[0] % 4) {
    case 0:
      options.rules = read_rules(in, "fuzz");
      break;
    case 1:
      options.domain_parts = read_domains(in, "fuzz");
      options.domains = formats::PdbOptions::Domains::file;
      options.levels = {"domain", "chain", "residue"};
      break;
    case 2:
      options.radii = read_radii(in, "fuzz");
      break;
    default:
      options.select = in.str();
    }
  } catch (const Error&) {
    return 0;
  }
  fuzz::structure(structure, options);
  return 0;
}
