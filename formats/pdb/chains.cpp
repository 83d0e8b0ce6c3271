// chains.cpp — runs of chains named and joined, residues and chains by hash.
#include "formats/pdb/chains.hpp"
#include "formats/pdb/atom_site.hpp"
#include <gemmi/cifdoc.hpp>
#include <string_view>
#include <unordered_map>

namespace molmesh::formats {
namespace {

constexpr char mark = '\x1f'; // mmCIF's characters are printable
constexpr size_t most_residues = 1024;

/// Equal where gemmi's ResidueId::matches() says so.
std::string key(const gemmi::ResidueId& r) {
  return r.seqid.num.str() + mark + static_cast<char>(r.seqid.icode | 0x20) + mark + r.name;
}

} // namespace

bool divide_long_chains(gemmi::cif::Loop& loop, AtomColumns& columns) {
  if (loop.length() <= most_residues)
    return false;
  columns.complete("auth_asym_id", {"label_asym_id"}, "A"); // gemmi keeps the label too
  const auto chain = static_cast<size_t>(columns.find("auth_asym_id")), width = loop.width();
  const int comp = columns.find("auth_comp_id");
  const int other[] = {columns.find("pdbx_PDB_model_num"), comp >= 0 ? comp : columns.find("label_comp_id"),
                       columns.find("auth_seq_id"), columns.find("pdbx_PDB_ins_code")};
  const auto may_be_divided = [](const std::string& name) {
    return !name.empty() && std::string_view("'\";").find(name.front()) == std::string_view::npos;
  };
  for (size_t row = 0; row < loop.length(); ++row)
    if (loop.val(row, chain).find(mark) != std::string::npos ||
        (other[0] >= 0 &&
         gemmi::cif::as_string(loop.val(row, size_t(other[0]))) != loop.val(row, size_t(other[0]))))
      return false; // gemmi takes every atom of a model without a plain name for a chain
  bool divided = false;
  std::string before; // the chain's name in the row before
  size_t residues = 0;
  for (size_t row = 0; row < loop.length(); ++row) {
    std::string& value = loop.values[row * width + chain];
    std::string name = gemmi::cif::as_string(value);
    const auto changes = [&](int column) {
      return row > 0 && column >= 0 && loop.val(row - 1, size_t(column)) != loop.val(row, size_t(column));
    };
    if (name != before || changes(other[0]))
      residues = 0;
    else if (changes(other[1]) || changes(other[2]) || changes(other[3]))
      ++residues;
    if (residues >= most_residues && may_be_divided(name)) {
      value = name + mark + std::to_string(residues / most_residues);
      divided = true;
    }
    before = std::move(name);
  }
  return divided;
}

void join_divided_chains(gemmi::Structure& structure) {
  for (gemmi::Model& model : structure.models) {
    std::vector<gemmi::Chain> whole;
    std::unordered_map<std::string, size_t> at; // of residues in the last of them, where it has been joined
    for (gemmi::Chain& chain : model.chains) {
      if (chain.name.find(mark) == std::string::npos) {
        whole.push_back(std::move(chain));
        at.clear();
        continue;
      }
      std::vector<gemmi::Residue>& residues = whole.back().residues; // of the run before
      if (at.empty())
        for (size_t r = 0; r < residues.size(); ++r)
          at.emplace(key(residues[r]), r);
      for (gemmi::Residue& r : chain.residues)
        if (const auto [known, fresh] = at.emplace(key(r), residues.size()); fresh)
          residues.push_back(std::move(r));
        else
          for (gemmi::Atom& atom : r.atoms)
            residues[known->second].atoms.push_back(std::move(atom));
    }
    model.chains = std::move(whole);
  }
}

void merge_chain_parts(gemmi::Structure& structure) {
  for (gemmi::Model& model : structure.models) {
    std::vector<gemmi::Chain> whole;
    std::unordered_map<std::string, size_t> at;
    for (gemmi::Chain& chain : model.chains)
      if (const auto [known, fresh] = at.emplace(chain.name, whole.size()); fresh)
        whole.push_back(std::move(chain));
      else
        whole[known->second].append_residues(std::move(chain.residues));
    model.chains = std::move(whole);
  }
}

} // namespace molmesh::formats
