// hier.hpp — reader and writer of .hier, versions 1 and 2 (HIERv1.md, HIERv2.md).
#pragma once
#include "molecule/hierarchy.hpp"
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace molmesh::formats {

/// Throws Error(bad_input) "FILE:LINE: Rn: found, expected", Rn a rule of the version's page; `file` names
/// the stream.
Hierarchy read_hier(std::istream& in, const std::string& file);
/// In the lowest version that holds the hierarchy. Numbers and names read back exactly. Same hierarchy, same bytes.
/// Throws what check() throws.
void write_hier(std::ostream& out, const Hierarchy& h);

/// Writes record by record, for hierarchies too large to hold. The caller opens groups outermost first, puts an
/// atom in each, and looks at the stream's state after finish().
class HierWriter {
public:
  enum class Version { v1, v2 };
  /// levels: words of letters, digits, '_' and '-', outermost first. Atoms of radius 0, bodies and weights other
  /// than 1 need version 2.
  HierWriter(std::ostream& out, std::string_view source, const std::vector<std::string>& levels,
             Version version = Version::v1);
  /// level: index into `levels`. Closes every open group of this level and below.
  void group(size_t level, std::string_view name, double exponent, double weight = 1);
  /// center, radius in Å; charge in elementary charges, NaN: none.
  void atom(std::string_view name, std::string_view element, Vec3d center, double radius, double charge);
  void body(std::string_view name, const Body& body);
  void finish();

private:
  void put(std::string_view word);
  void put_name(std::string_view name);
  void put_number(double value);
  void end_record();
  std::ostream& out_;
  std::vector<std::string> levels_;
  std::string buffer_;
};

} // namespace molmesh::formats
