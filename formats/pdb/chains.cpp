// chains.cpp — runs of chains joined by the hash of their names.
#include "formats/pdb/chains.hpp"
#include <algorithm>
#include <functional>
#include <iterator>
#include <string_view>
#include <unordered_map>

namespace molmesh::formats {

namespace {

/// Takes less memory than a table of the names; equal ones of a structure are one text.
bool have_names_of_their_own(const std::vector<pdb::Chain>& chains) {
  std::vector<const std::string*> name;
  name.reserve(chains.size());
  for (const pdb::Chain& chain : chains)
    name.push_back(&chain.name.str());
  std::sort(name.begin(), name.end(), std::less<>());
  return std::adjacent_find(name.begin(), name.end()) == name.end();
}

} // namespace

void merge_chain_parts(pdb::Structure& structure) {
  for (pdb::Model& model : structure.models) {
    if (have_names_of_their_own(model.chains))
      continue;
    struct Joined {
      size_t chain, residues; ///< its place among the joined; of all its parts
    };
    std::unordered_map<std::string_view, Joined> joined;
    size_t count = 0;
    for (const pdb::Chain& chain : model.chains) {
      const auto [known, fresh] = joined.try_emplace(chain.name.str(), Joined{count, 0});
      count += fresh;
      known->second.residues += chain.residues.size();
    }
    std::vector<pdb::Chain> whole;
    whole.reserve(count);
    for (pdb::Chain& chain : model.chains) {
      const Joined& j = joined.at(chain.name.str());
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
