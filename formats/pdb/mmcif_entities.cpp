// mmcif_entities.cpp — entities looked up by hash.
#include "formats/pdb/mmcif_entities.hpp"
#include <gemmi/cif.hpp>
#include <gemmi/mmcif.hpp>
#include <set>
#include <unordered_map>

namespace molmesh::formats {
namespace {
namespace cif = gemmi::cif;

/// The first entity of each name.
std::unordered_map<std::string, gemmi::Entity*> by_name(std::vector<gemmi::Entity>& entities) {
  std::unordered_map<std::string, gemmi::Entity*> of_name;
  for (gemmi::Entity& entity : entities)
    of_name.try_emplace(entity.name, &entity);
  return of_name;
}

/// Returns whether the file names the subchains.
bool read(cif::Block& block, std::vector<gemmi::Entity>& entities) {
  std::unordered_map<std::string, std::string> of_polymer;
  for (const auto row : block.find("_entity_poly.", {"entity_id", "type"}))
    of_polymer.try_emplace(row.str(0), row.str(1));
  for (const auto row : block.find("_entity.", {"id", "type"})) {
    gemmi::Entity& entity = entities.emplace_back(row.str(0));
    entity.entity_type = gemmi::entity_type_from_string(row.str(1));
    if (const auto polymer = of_polymer.find(entity.name); polymer != of_polymer.end())
      entity.polymer_type = gemmi::polymer_type_from_string(polymer->second);
  }
  const std::unordered_map<std::string, gemmi::Entity*> of_name = by_name(entities);
  for (const auto row : block.find("_entity_poly_seq.", {"entity_id", "num", "mon_id"})) {
    const auto known = of_name.find(row.str(0));
    if (known == of_name.end())
      continue;
    std::vector<std::string>& sequence = known->second->full_sequence;
    const int place = cif::as_int(row[1], 0) - 1, length = static_cast<int>(sequence.size());
    if (place == length)
      sequence.push_back(row.str(2));
    else if (place >= 0 && place < length) // alternatives
      sequence[static_cast<size_t>(place)] += "," + row.str(2);
  }
  cif::Table subchains = block.find("_struct_asym.", {"id", "entity_id"});
  for (const auto row : subchains)
    if (const auto known = of_name.find(row.str(1)); known != of_name.end())
      known->second->subchains.push_back(row.str(0));
  return subchains.ok();
}

/// Calls take(begin, end) for each run of residues of one subchain that stand together in the file.
template <class Take>
void for_each_run(const pdb::Chain& chain, Take take) {
  const std::vector<pdb::Residue>& r = chain.residues;
  for (size_t begin = 0, end = 0; begin < r.size(); begin = end) {
    for (end = begin + 1; end < r.size() && !r[end].begins_run && r[end].subchain == r[begin].subchain;)
      ++end;
    take(begin, end);
  }
}

void name_subchains_of_entities(pdb::Structure& st) {
  const std::unordered_map<std::string, gemmi::Entity*> of_name = by_name(st.entities);
  std::set<std::pair<gemmi::Entity*, std::string>> known;
  for (const pdb::Chain& chain : st.models[0].chains)
    for_each_run(chain, [&](size_t begin, size_t) {
      const pdb::Residue& first = chain.residues[begin];
      const auto entity = of_name.find(first.entity_id);
      if (entity != of_name.end() && known.emplace(entity->second, first.subchain).second)
        entity->second->subchains.push_back(first.subchain);
    });
}

/// How many residues a run has: those of one number that follow each other are one, in alternatives.
size_t length(const pdb::Chain& chain, size_t begin, size_t end) {
  size_t n = 1;
  for (size_t r = begin + 1; r < end; ++r)
    n += chain.residues[r].seqid != chain.residues[r - 1].seqid;
  return n;
}

void set_entity_types(pdb::Structure& st) {
  std::unordered_map<std::string, gemmi::EntityType> of_subchain;
  for (const gemmi::Entity& entity : st.entities)
    for (const std::string& subchain : entity.subchains)
      of_subchain.try_emplace(subchain, entity.entity_type);
  for (pdb::Model& model : st.models)
    for (pdb::Chain& chain : model.chains)
      for_each_run(chain, [&](size_t begin, size_t end) {
        const pdb::Residue& first = chain.residues[begin];
        const auto known = first.subchain.empty() ? of_subchain.end() : of_subchain.find(first.subchain);
        gemmi::EntityType type = known == of_subchain.end() ? gemmi::EntityType::Unknown : known->second;
        if (type == gemmi::EntityType::Unknown)
          type = first.is_water()                ? gemmi::EntityType::Water
                 : length(chain, begin, end) > 1 ? gemmi::EntityType::Polymer
                                                 : gemmi::EntityType::NonPolymer;
        for (size_t r = begin; r < end; ++r)
          chain.residues[r].entity_type = type;
      });
}

} // namespace

void read_entities(cif::Block& block, pdb::Structure& structure) {
  structure.entities.clear();
  if (!read(block, structure.entities) && !structure.models.empty())
    name_subchains_of_entities(structure);
  set_entity_types(structure);
}

} // namespace molmesh::formats
