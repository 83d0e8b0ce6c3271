// remark350.hpp — biological assemblies of the PDB format.
#pragma once
#include <gemmi/model.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace molmesh::formats {

/// Fed with the REMARK 350 lines of a file. Fields between blanks: from the 1000th operator on they leave their
/// columns.
class Remark350 {
public:
  /// where: "FILE:LINE". Throws Error(bad_input) for a matrix that is none.
  void take(std::string_view line, const std::string& where);
  /// Throws where the last matrix is short of rows.
  void finish() const;
  std::vector<gemmi::Assembly> assemblies;

private:
  std::string serial_, where_; ///< of the operator that has some rows
  gemmi::Transform transform_;
  int rows_ = 0;
};

} // namespace molmesh::formats
