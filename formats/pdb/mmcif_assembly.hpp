// mmcif_assembly.hpp — biological assemblies of mmCIF: pdbx_struct_assembly_gen and pdbx_struct_oper_list.
#pragma once
#include <gemmi/cifdoc.hpp>
#include <gemmi/model.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace molmesh::formats {

/// "(1-60)(61-88)", "1,2,5", "(X0)(1-10)": every product, as operator identifiers from left to right; the rightmost
/// is applied first. Throws Error(bad_input) "WHERE: …" on other syntax and on more than 100,000 products.
std::vector<std::vector<std::string>> parse_operators(std::string_view expression, const std::string& where);

/// All assemblies by name; generators only for the one that is wanted, since an expression of ten characters can
/// mean 10⁵ operators.
std::vector<gemmi::Assembly> read_assemblies(gemmi::cif::Block& block, const std::string& wanted,
                                             const std::string& file);

} // namespace molmesh::formats
