// structure_builder.cpp — a residue is a run of atoms, joined to an earlier one unless it repeats an atom.
#include "formats/pdb/structure_builder.hpp"
#include "molecule/words.hpp"
#include <algorithm>
#include <utility>

namespace molmesh::formats {
namespace {

/// Name and alternative location: what a residue has once.
std::string label_of(const pdb::Atom& a) {
  return a.name.str() + '\n' + a.altloc;
}

std::string_view field(std::string_view line, size_t at, size_t width) {
  return at < line.size() ? trimmed(line.substr(at, width)) : std::string_view{};
}

} // namespace

void StructureBuilder::open_model(const std::string& name) {
  close_residue();
  structure_.models.emplace_back(name);
  chain_open_ = false;
  chains_.clear();
}

void StructureBuilder::open_chain(std::string_view name) {
  pdb::Model& model = structure_.models.back();
  const auto [first, is_new] = chains_.try_emplace(std::string(name), model.chains.size());
  after_ter_ = !is_new && model.chains[first->second].residues[0].entity_type == gemmi::EntityType::Polymer;
  model.chains.emplace_back(label(name));
  chain_open_ = true;
  slot_.clear();
}

void StructureBuilder::add(std::string_view name, const pdb::ResidueId& id, bool hetero, bool has_number,
                           const pdb::Atom& atom) {
  if (!chain_open_ || chain().name != name) {
    close_residue();
    open_chain(name);
  }
  const bool begins_again = !has_number && !atoms_.empty() && label_of(atoms_[0]) == label_of(atom);
  if (begins_again || !run_.matches(id))
    close_residue();
  if (atoms_.empty()) {
    static_cast<pdb::ResidueId&>(run_) = id;
    run_.het_flag = hetero ? 'H' : 'A';
  }
  atoms_.emplace_back(atom);
}

bool StructureBuilder::repeats(Slot& slot) const {
  if (!slot.atoms) {
    slot.atoms = std::make_unique<std::unordered_set<std::string>>();
    for (const pdb::Atom& a : structure_.models.back().chains.back().residues[slot.residue].atoms)
      slot.atoms->insert(label_of(a));
  }
  for (size_t a = 0; a < atoms_.size(); ++a)
    if (slot.atoms->count(label_of(atoms_[a])) != 0)
      return true;
  return false;
}

void StructureBuilder::close_residue() {
  if (atoms_.empty())
    return;
  std::vector<pdb::Residue>& residues = chain().residues;
  const size_t hash = pdb::hash(run_);
  auto [found, end] = slot_.equal_range(hash);
  while (found != end && !residues[found->second.residue].matches(run_))
    ++found;
  const bool is_new = found == end;
  if (is_new)
    found = slot_.emplace(hash, Slot{residues.size(), nullptr});
  Slot& slot = found->second;
  if (!is_new && !repeats(slot)) {
    for (size_t a = 0; a < atoms_.size(); ++a)
      slot.atoms->insert(label_of(atoms_[a]));
    atoms_.move_to(residues[slot.residue].atoms);
    return;
  }
  if (!is_new) {
    ++restarted_;
    slot = Slot{residues.size(), nullptr};
  }
  if (after_ter_)
    run_.entity_type = run_.is_water() ? gemmi::EntityType::Water : gemmi::EntityType::NonPolymer;
  residues.push_back(std::move(run_));
  atoms_.move_to(residues.back().atoms);
  run_ = pdb::Residue();
}

void StructureBuilder::end_polymer() {
  close_residue();
  if (!chain_open_ || after_ter_)
    return;
  for (pdb::Residue& residue : chain().residues)
    residue.entity_type = gemmi::EntityType::Polymer;
  after_ter_ = true;
}

void StructureBuilder::add_sequence(std::string_view line) {
  const auto [known, is_new] = entity_.try_emplace(std::string(field(line, 10, 2)), structure_.entities.size());
  if (is_new)
    structure_.entities.emplace_back(known->first);
  gemmi::Entity& entity = structure_.entities[known->second];
  entity.entity_type = gemmi::EntityType::Polymer;
  for (size_t at = 19; at < 68; at += 4)
    if (const std::string_view name = field(line, at, 3); !name.empty())
      entity.full_sequence.emplace_back(name);
}

void StructureBuilder::finish() {
  close_residue();
  for (pdb::Model& model : structure_.models)
    for (pdb::Chain& chain : model.chains)
      if (chain.residues[0].entity_type != gemmi::EntityType::Unknown)
        pdb::name_subchains(chain, structure_.labels);
  const auto is_polymer = [](const pdb::Residue& r) { return r.entity_type == gemmi::EntityType::Polymer; };
  for (const pdb::Chain& chain : structure_.models[0].chains) {
    const auto entity = entity_.find(chain.name);
    if (entity == entity_.end())
      continue;
    const auto polymer = std::find_if(chain.residues.begin(), chain.residues.end(), is_polymer);
    if (polymer != chain.residues.end())
      structure_.entities[entity->second].subchains.push_back(polymer->subchain);
  }
}

int64_t part_restarted(pdb::Structure& structure) {
  int64_t restarted = 0;
  const auto stands_apart = [](const pdb::Residue& r) {
    return !r.atoms.empty() && r.atoms.back().serial - r.atoms.front().serial >= static_cast<int>(r.atoms.size());
  };
  for (pdb::Model& model : structure.models)
    for (pdb::Chain& chain : model.chains) {
      if (std::none_of(chain.residues.begin(), chain.residues.end(), stands_apart))
        continue;
      Chunks<pdb::Residue> parts;
      bool any_empty = false;
      for (pdb::Residue& residue : chain.residues) {
        const std::vector<pdb::Atom> atoms = std::exchange(residue.atoms, {});
        std::unordered_set<std::string> labels;
        for (size_t begin = 0, end = 0; begin < atoms.size(); begin = end) {
          for (end = begin + 1; end < atoms.size() && atoms[end].serial == atoms[end - 1].serial + 1;)
            ++end;
          const bool again =
              begin > 0 && std::any_of(atoms.begin() + static_cast<std::ptrdiff_t>(begin),
                                       atoms.begin() + static_cast<std::ptrdiff_t>(end),
                                       [&](const auto& a) { return labels.count(label_of(a)) != 0; });
          if (again) {
            parts.emplace_back(residue);
            residue.atoms.clear();
            labels.clear();
            ++restarted;
          }
          for (size_t a = begin; a < end; ++a) {
            labels.insert(label_of(atoms[a]));
            residue.atoms.push_back(atoms[a]);
          }
        }
        parts.emplace_back(std::move(residue));
        any_empty |= parts.back().atoms.empty();
      }
      std::vector<pdb::Residue>().swap(chain.residues);
      parts.move_to(chain.residues);
      if (!any_empty) // no two begin with the same atom
        std::sort(chain.residues.begin(), chain.residues.end(),
                  [](const auto& a, const auto& b) { return a.atoms[0].serial < b.atoms[0].serial; });
    }
  return restarted;
}

} // namespace molmesh::formats
