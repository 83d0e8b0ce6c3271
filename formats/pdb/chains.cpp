// chains.cpp — runs of chains joined by the hash of their names.
#include "formats/pdb/chains.hpp"
#include <algorithm>
#include <iterator>
#include <string_view>
#include <unordered_map>

namespace molmesh::formats {

void merge_chain_parts(pdb::Structure& structure) {
  for (pdb::Model& model : structure.models) {
    struct Joined {
      size_t chain, residues; ///< its place among the joined; of all its parts
    };
    std::unordered_map<std::string_view, Joined> joined;
    size_t count = 0;
    for (const pdb::Chain& chain : model.chains) {
      const auto [known, fresh] = joined.try_emplace(chain.name, Joined{count, 0});
      count += fresh;
      known->second.residues += chain.residues.size();
    }
    if (count == model.chains.size())
      continue;
    std::vector<pdb::Chain> whole;
    whole.reserve(count);
    for (pdb::Chain& chain : model.chains) {
      const Joined& j = joined.at(chain.name);
      if (j.chain == whole.size())
        whole.emplace_back(chain.name).residues.reserve(j.residues);
      std::vector<pdb::Residue>& residues = whole[j.chain].residues;
      std::move(chain.residues.begin(), chain.residues.end(), std::back_inserter(residues));
      std::vector<pdb::Residue>().swap(chain.residues);
    }
    model.chains = std::move(whole);
  }
}

} // namespace molmesh::formats
