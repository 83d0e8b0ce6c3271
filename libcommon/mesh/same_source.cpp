// same_source.cpp — compares checksums of structures, isovalues, decay rates and numbers of atoms.
#include "mesh/same_source.hpp"
#include "base/error.hpp"
#include "base/grouped.hpp"
#include <cmath>
#include <sstream>

namespace molmesh {
namespace {

std::string sum_of(const std::string& source) {
  const size_t at = source.find("sha256:");
  return at == std::string::npos ? "" : source.substr(at, source.find_first_of(" \t\n", at) - at);
}

} // namespace

bool other_structure(const std::string& source, const std::string& of_mesh) {
  const std::string a = sum_of(source), b = sum_of(of_mesh);
  return !a.empty() && !b.empty() && a != b;
}

void require_same_source(const TetMesh& m, bool has_isovalue, const FieldInfo& field, const std::string& density) {
  if (other_structure(field.source, m.source))
    fail_input(density + ": the density of " + field.source + ", expected the mesh's " + m.source);
  if (m.source.empty())
    return;
  if (m.atoms > 0 && field.atoms > 0 && m.atoms != field.atoms)
    fail_input(density + ": the density of " + grouped(field.atoms) + (field.atoms == 1 ? " atom" : " atoms") +
               ", expected the mesh's " + grouped(m.atoms));
  const auto require = [&](const char* name, double here, double expected) {
    if (std::abs(expected - here) <= 1e-9 * std::abs(here))
      return;
    std::ostringstream s;
    s << density << ": the " << name << ' ' << here << ", expected the mesh's " << expected;
    fail_input(s.str());
  };
  if (has_isovalue)
    require("isovalue", field.isovalue, m.isovalue);
  if (m.decay > 0)
    require("decay rate", field.decay, m.decay);
}

} // namespace molmesh
